"""JPEG files without what was written into them beside the picture; pixels stay as they are, to the bit."""

from __future__ import annotations

from collections.abc import Iterator

START, END, SCAN, COMMENT = 0xD8, 0xD9, 0xDA, 0xFE
APP0, APP2, ADOBE = 0xE0, 0xE2, 0xEE
APPLICATION = range(0xE0, 0xF0)
ALONE = {0x01, *range(0xD0, 0xD8)}  # markers without a length
JFIF, PROFILE = b"JFIF\0", b"ICC_PROFILE\0"


class JpegError(ValueError):
    """Bytes that are not laid out like a JPEG."""


def without_metadata(data: bytes) -> bytes:
    """Without Exif, XMP, comments, thumbnails and whatever follows the picture: place, serial numbers, names.

    What a decoder needs to show the same colours stays. Raises JpegError.
    """
    return b"\xff\xd8" + b"".join(_kept(marker, part) for marker, part in _segments(data))


def _segments(data: bytes) -> Iterator[tuple[int, bytes]]:
    """Marker and all bytes of every segment after the start, a scan with its picture data, up to the end."""
    if data[:2] != bytes((0xFF, START)):
        raise JpegError("no start")
    place = 2
    while True:
        if place + 2 > len(data) or data[place] != 0xFF:
            raise JpegError(f"no marker at byte {place}")
        marker = data[place + 1]
        if marker == 0xFF:  # padding
            place += 1
            continue
        after = place + 2
        if marker not in ALONE and marker != END:
            after += max(2, int.from_bytes(data[after : after + 2], "big"))
        if marker == SCAN:
            after = _end_of_scan(data, after)
        yield marker, data[place:after]
        if marker == END:
            return
        place = after


def _end_of_scan(data: bytes, place: int) -> int:
    """Where the next marker is that belongs to no scan."""
    while (place := data.find(b"\xff", place)) >= 0 and place + 1 < len(data):
        if data[place + 1] not in {0x00, 0xFF, *ALONE}:
            return place
        place += 1 if data[place + 1] == 0xFF else 2
    raise JpegError("no end")


def _kept(marker: int, part: bytes) -> bytes:
    content = part[4:]
    if marker == APP0 and content.startswith(JFIF) and len(content) >= 14:
        # Version and density; the two bytes after them are the size of a thumbnail.
        return part if len(content) == 14 else b"\xff\xe0\x00\x10" + content[:12] + b"\0\0"
    if marker == ADOBE or (marker == APP2 and content.startswith(PROFILE)):
        return part
    return b"" if marker in APPLICATION or marker == COMMENT else part

"""Pictures out of folders, zips and videos, good and bad."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

from gtm_hit.calibration.detection import find_board
from gtm_hit.calibration.sources import SourceError, open_source
from gtm_hit.calibration.views import BoardView, NotFound, Picture
from tests.calibration.board_scene import CHESS, SIZE, drawn, write_pictures

GREY = drawn("chessboard", 12)[0][1]


def read(path: Path) -> list[Picture | NotFound]:
    return list(open_source(path).read())


def found_in(path: Path) -> BoardView:
    (picture,) = read(path)
    assert isinstance(picture, Picture), picture
    view = find_board(picture, CHESS)
    assert isinstance(view, BoardView), view
    return view


def test_a_folder_gives_its_pictures_in_order_and_leaves_out_other_files(tmp_path: Path) -> None:
    write_pictures(tmp_path, 3)
    (tmp_path / "notes.txt").write_text("hello")
    source = open_source(tmp_path)
    assert (source.size, source.count) == (SIZE, 3)
    assert [picture.name for picture in source.read()] == ["00.png", "01.png", "02.png"]


def test_a_zip_gives_the_same_as_the_folder(tmp_path: Path) -> None:
    folder = write_pictures(tmp_path / "pictures", 2)
    with zipfile.ZipFile(tmp_path / "p.zip", "w") as archive:
        for file in sorted(folder.iterdir()):
            archive.write(file, f"camera/{file.name}")
        archive.writestr("__MACOSX/camera/._00.png", b"rubbish")
    pairs = zip(read(folder), read(tmp_path / "p.zip"), strict=True)
    for one, other in pairs:
        assert isinstance(one, Picture) and isinstance(other, Picture)
        assert np.array_equal(one.grey, other.grey)


@pytest.mark.parametrize("kind", ["16 bit", "colour", "transparent", "grey"])
def test_a_picture_of_any_depth_shows_the_board_in_the_same_place(tmp_path: Path, kind: str) -> None:
    pixels = {
        "16 bit": 3000 + GREY.astype(np.uint16) * 12,
        "colour": cv2.cvtColor(GREY, cv2.COLOR_GRAY2BGR),
        "transparent": cv2.cvtColor(GREY, cv2.COLOR_GRAY2BGRA),
        "grey": GREY,
    }[kind]
    cv2.imwrite(str(tmp_path / "a.png"), pixels)
    expected = find_board(Picture("a", GREY), CHESS)
    assert isinstance(expected, BoardView)
    assert np.abs(found_in(tmp_path).pixels - expected.pixels).max() < 0.05


def test_pixels_are_used_as_stored_whatever_exif_asks_for_and_it_is_said(tmp_path: Path) -> None:
    exif = Image.Exif()
    exif[0x0112] = 6  # to be turned by a quarter
    Image.fromarray(GREY).save(tmp_path / "a.jpg", exif=exif, quality=98)
    source = open_source(tmp_path)
    assert source.size == SIZE
    assert "turn" in source.notes[0] and "as stored" in source.notes[0]
    assert found_in(tmp_path).pixels[:, 0].max() < SIZE[0]


def test_upright_pictures_are_pictures_like_others(tmp_path: Path) -> None:
    cv2.imwrite(str(tmp_path / "a.png"), np.ascontiguousarray(np.rot90(GREY)))
    assert open_source(tmp_path).size == SIZE[::-1]
    assert len(found_in(tmp_path).pixels) == CHESS.point_count


def test_two_sizes_in_one_folder_are_refused_and_the_odd_ones_named(tmp_path: Path) -> None:
    write_pictures(tmp_path, 3)
    cv2.imwrite(str(tmp_path / "x.png"), cv2.resize(GREY, (320, 200)))
    with pytest.raises(SourceError, match=r"3 of 640×400, 1 of 320×200 \(x\.png\)"):
        open_source(tmp_path)


def test_upright_pictures_among_others_are_refused_and_told_so(tmp_path: Path) -> None:
    write_pictures(tmp_path, 3)
    cv2.imwrite(str(tmp_path / "x.png"), np.ascontiguousarray(np.rot90(GREY)))
    with pytest.raises(SourceError, match="upright"):
        open_source(tmp_path)


def test_a_damaged_picture_is_told_and_the_others_are_read(tmp_path: Path) -> None:
    write_pictures(tmp_path, 2)
    (tmp_path / "00.png").write_bytes(b"no picture")
    (tmp_path / "05.png").write_bytes(b"")
    names = {each.name: type(each).__name__ for each in read(tmp_path)}
    assert names == {"00.png": "NotFound", "01.png": "Picture", "05.png": "NotFound"}


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("empty", None, "no pictures"),
        ("nowhere", b"", "not there"),
        ("a.png", b"x", "single picture"),
        ("a.mp4", b"not a video", "cannot be|neither"),
        ("a.zip", b"PK\x05\x06" + bytes(18), "no pictures"),
    ],
)
def test_what_holds_no_pictures_is_refused_with_a_sentence(
    tmp_path: Path, name: str, content: bytes | None, said: str
) -> None:
    path = tmp_path / name
    if content is None:
        path.mkdir()
    elif content:
        path.write_bytes(content)
    with pytest.raises(SourceError, match=said):
        read(path)


def test_a_folder_with_a_video_only_says_to_give_the_video(tmp_path: Path) -> None:
    (tmp_path / "camera.mp4").write_bytes(b"")
    with pytest.raises(SourceError, match=r"give camera\.mp4 itself"):
        open_source(tmp_path)


def make_video(path: Path, frames: list[np.ndarray]) -> Path:
    writer = cv2.VideoWriter(str(path), cv2.CAP_FFMPEG, cv2.VideoWriter.fourcc(*"MJPG"), 30, SIZE)
    for frame in frames:
        writer.write(cv2.cvtColor(frame, cv2.COLOR_GRAY2BGR))
    writer.release()
    return path


def test_of_a_video_frames_are_sampled_and_the_sharper_neighbour_is_taken(tmp_path: Path) -> None:
    soft = cv2.GaussianBlur(GREY, (0, 0), 3)
    video = make_video(tmp_path / "v.avi", [soft, soft, GREY, GREY, soft, soft] * 4)
    source = open_source(video, sampled=4)
    pictures = list(source.read())
    assert [each.name for each in pictures] == [f"frame-{number:06d}" for number in (2, 8, 14, 20)]
    assert all(isinstance(each, Picture) and find_board(each, CHESS) for each in pictures)


def test_a_blurred_frame_of_a_video_is_left_out_and_told(tmp_path: Path) -> None:
    soft = cv2.GaussianBlur(GREY, (0, 0), 6)
    pictures = list(open_source(make_video(tmp_path / "v.avi", [GREY] * 8 + [soft])).read())
    told = [each for each in pictures if isinstance(each, NotFound)]
    assert len(pictures) == 9
    assert [each.name for each in told] == ["frame-000008"] and "blurred" in told[0].reason


def test_a_zip_whose_member_is_damaged_tells_of_that_member(tmp_path: Path) -> None:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name in ("a.png", "b.png"):
            archive.writestr(name, cv2.imencode(".png", GREY)[1].tobytes())
    data = bytearray(stream.getvalue())
    data[len(data) // 4] ^= 0xFF
    (tmp_path / "p.zip").write_bytes(bytes(data))
    kinds = [type(each).__name__ for each in read(tmp_path / "p.zip")]
    assert kinds == ["NotFound", "Picture"]

"""Where a request comes from."""

from __future__ import annotations

from ipaddress import IPv6Address, ip_address, ip_network

from django.conf import settings
from django.http import HttpRequest


def client_address(request: HttpRequest) -> str:
    """The nearest address that is no proxy of ours; what stands before it in the header is only a claim."""
    chain = [*request.META.get("HTTP_X_FORWARDED_FOR", "").split(","), request.META.get("REMOTE_ADDR", "")]
    nearest = ""
    for hop in reversed([each.strip() for each in chain]):
        try:
            address = ip_address(hop)
        except ValueError:
            break
        # A household has 2^64 addresses of IPv6 to choose from.
        wide = isinstance(address, IPv6Address) and address.ipv4_mapped is None
        nearest = str(ip_network(f"{address}/64", strict=False)) if wide else str(address)
        if not any(address in network for network in settings.TRUSTED_PROXIES):
            break
    return nearest

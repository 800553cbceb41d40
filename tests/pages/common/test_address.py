from __future__ import annotations

from ipaddress import ip_network
from typing import Any

import pytest
from django.test import RequestFactory

from gtm_hit.pages.common.address import client_address


@pytest.mark.parametrize(
    ("peer", "forwarded", "address"),
    [
        ("192.0.2.1", "", "192.0.2.1"),
        ("192.0.2.1", "198.51.100.7", "192.0.2.1"),
        ("172.18.0.2", "198.51.100.7", "198.51.100.7"),
        ("172.18.0.2", "203.0.113.5, 198.51.100.7", "198.51.100.7"),
        ("172.18.0.2", "198.51.100.7, 172.18.0.9", "198.51.100.7"),
        ("172.18.0.2", "nonsense", "172.18.0.2"),
        ("2001:db8:1:2:3:4:5:6", "", "2001:db8:1:2::/64"),
        ("", "198.51.100.7", ""),
    ],
)
def test_only_proxies_of_ours_are_believed(settings: Any, peer: str, forwarded: str, address: str) -> None:
    settings.TRUSTED_PROXIES = [ip_network("172.18.0.0/16")]
    headers = {"x-forwarded-for": forwarded} if forwarded else {}
    assert client_address(RequestFactory().get("/", REMOTE_ADDR=peer, headers=headers)) == address

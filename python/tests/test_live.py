# SPDX-License-Identifier: MIT OR Apache-2.0
"""The live page is served as long as its block lasts."""

from __future__ import annotations

import urllib.error
import urllib.request

import pytest

import hapticore as hc


def test_a_page_is_served_until_its_block_ends() -> None:
    with hc.live("hockey") as page:
        with urllib.request.urlopen(page.url, timeout=10) as answer:
            assert answer.status == 200
            assert b"<html" in answer.read().lower()
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(page.url, timeout=2)
    page.close()


def test_two_pages_have_ports_of_their_own() -> None:
    with hc.live("hockey") as one, hc.live("minimal-sheet") as other:
        assert one.url != other.url


def test_a_port_in_use_is_an_error() -> None:
    with hc.live("hockey") as page:
        port = int(page.url.rstrip("/").rsplit(":", 1)[1])
        with pytest.raises((hc.Error, OSError), match=str(port)):
            hc.live("hockey", port=port)

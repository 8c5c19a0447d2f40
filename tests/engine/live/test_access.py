"""Nobody but this machine gets in without a token, and no page of another site at all."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.engine.errors import StudioError
from studio.engine.live.access import Address, check_address, check_url, is_loopback, refusal

TOKEN = "open sesame"


@pytest.mark.parametrize(
    ("text", "host", "port", "url"),
    [
        ("127.0.0.1:8765", "127.0.0.1", 8765, "ws://127.0.0.1:8765"),
        ("localhost:0", "localhost", 0, "ws://localhost:0"),
        ("[::1]:9000", "::1", 9000, "ws://[::1]:9000"),
        ("[fe80::1%eth0]:9000", "fe80::1%eth0", 9000, "ws://[fe80::1%eth0]:9000"),
    ],
)
def test_addresses(text: str, host: str, port: int, url: str) -> None:
    address = Address.parse(text)
    assert (address.host, address.port, address.url, str(address)) == (host, port, url, text)


@pytest.mark.parametrize(
    "text", ["", "8765", "localhost", "localhost:", ":80", "h:99999", "h:-1", "h:٣", "[]:1", "[h:1"]
)
def test_no_addresses(text: str) -> None:
    with pytest.raises(StudioError, match="HOST:PORT") as refused:
        Address.parse(text)
    assert "brackets" not in str(refused.value)


@pytest.mark.parametrize("text", ["::1", "::1:8765", "2001:db8::1", "::", "[::1]", "[::1]8765"])
def test_where_a_bare_address_ends_is_not_guessed(text: str) -> None:
    with pytest.raises(StudioError, match=r"brackets: \[::1\]:8765"):
        Address.parse(text)


@pytest.mark.parametrize("url", ["ws://127.0.0.1:8765", "wss://x", "ws://[::1]:1/?token=a"])
def test_where_one_can_send_to(url: str) -> None:
    check_url(url)


@pytest.mark.parametrize(
    "url",
    [
        "",
        "x",
        "http://x",
        "ws://",
        "ws://x:port",
        "ws://x:99999",
        "ws://x:0",
        "ws://[::1",
        "ws://:1",
    ],
)
def test_where_one_cannot(url: str) -> None:
    with pytest.raises(StudioError, match=r"--to: expected an address such as ws://127.0.0.1:8765"):
        check_url(url)


def test_all_of_this_machines_addresses_are_shown_as_its_name() -> None:
    assert "0.0.0.0" not in Address("0.0.0.0", 80).url


@pytest.mark.parametrize(
    "host", ["0.0.0.0", "192.168.1.5", "::", "example.org", "127.0.0.1.nip.io"]
)
def test_beyond_this_machine_a_token_is_needed(host: str) -> None:
    with pytest.raises(StudioError, match="--token"):
        check_address(Address(host), None)
    check_address(Address(host), TOKEN)


@pytest.mark.parametrize("host", ["127.0.0.1", "127.8.8.8", "::1", "localhost"])
def test_this_machine_needs_none(host: str) -> None:
    check_address(Address(host), None)


def test_a_token_that_can_be_guessed_is_refused() -> None:
    with pytest.raises(StudioError, match="8 characters"):
        check_address(Address(), "1234")


def test_a_token_comes_in_the_query_or_in_a_header() -> None:
    assert not refusal("/?token=open%20sesame", "", None, TOKEN)
    assert not refusal("/", "Bearer open sesame", None, TOKEN)
    assert not refusal("/", "bearer open sesame", "https://example.org", TOKEN)
    for path, header in [("/", ""), ("/?token=", ""), ("/?token=Open", ""), ("/", "Basic x")]:
        assert "token" in refusal(path, header, None, TOKEN)


@settings(deadline=None, derandomize=True)
@given(st.text(max_size=40), st.text(max_size=40))
def test_only_the_token_opens(path: str, header: str) -> None:
    assert refusal(path, header, None, TOKEN)


@pytest.mark.parametrize(
    "origin",
    ["https://example.org", "null", "", "http://localhost.example.org", "http://[", "file://"],
)
def test_other_sites_pages_are_kept_out(origin: str) -> None:
    assert "page of another site" in refusal("/", "", origin, None)


@pytest.mark.parametrize(
    "origin", [None, "http://localhost:8080", "http://127.0.0.1", "http://[::1]"]
)
def test_programs_and_this_machines_pages_are_let_in(origin: str | None) -> None:
    assert not refusal("/", "", origin, None)


def test_names_that_only_look_like_this_machine() -> None:
    assert not is_loopback("localhost.example.org")
    assert not is_loopback("")

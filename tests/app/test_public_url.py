"""Behind a proxy: the public address decides links, cookies and whose pages may write."""

import http.client
import re
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest

from app.server.public_url import parse_public_url
from app.server.serving import shown_host
from data.errors import InputError
from tests.conftest import PATIENCE_S

from .conftest import TINY_STUDY, Server, free_port, serving

PUBLIC = "https://study.example.org"
INSIDE = "127.0.0.1:8501"
"""What a proxy that doesn't pass Host on puts there."""


@pytest.fixture(scope="module")
def behind(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A server that a proxy with TLS stands before; its own port is kept in a file."""
    port = free_port()
    folder = tmp_path_factory.mktemp("behind")
    (folder / "port").write_text(str(port))
    (folder / "secret").write_text("seven green apples")
    options = ("--public-url", PUBLIC, "--port", str(port), "--passphrase-file", "secret")
    with serving(folder, TINY_STUDY, *options) as running:
        yield running


def ask(
    server: Server, path: str, method: str = "GET", body: str | None = None, **headers: str
) -> tuple[int, dict[str, str]]:
    """A request as a proxy on this machine sends it on."""
    port = int((server.log.parent / "port").read_text())
    sent = {
        "Host": INSIDE,
        "X-Forwarded-Proto": "https",
        "X-Forwarded-For": "203.0.113.7",
        **{name.replace("_", "-"): value for name, value in headers.items()},
    }
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
    try:
        connection.request(method, path, body, sent)
        answer = connection.getresponse()
        return answer.status, {name.lower(): value for name, value in answer.getheaders()}
    finally:
        connection.close()


def upgrade(server: Server, path: str, origin: str) -> int:
    status, _ = ask(
        server,
        path,
        Connection="Upgrade",
        Upgrade="websocket",
        Sec_WebSocket_Version="13",
        Sec_WebSocket_Key="AAAAAAAAAAAAAAAAAAAAAA==",
        Origin=origin,
    )
    return status


def test_links_begin_with_the_public_address(behind: Server) -> None:
    assert behind.participant_url.startswith(f"{PUBLIC}/join/")
    assert behind.researcher_url.startswith(f"{PUBLIC}/researcher/")


@pytest.mark.parametrize("door", ["participant_url", "researcher_url"])
def test_cookies_come_along_over_tls_alone(behind: Server, door: str) -> None:
    status, headers = ask(behind, urlsplit(getattr(behind, door)).path)
    assert status == 303
    assert headers["location"].startswith("/")
    attributes = headers["set-cookie"].split("; ")
    assert {"Secure", "HttpOnly", "SameSite=lax"} <= set(attributes)


def test_the_passphrase_s_cookie_comes_along_over_tls_alone(behind: Server) -> None:
    status, headers = ask(
        behind,
        "/researcher",
        "POST",
        "passphrase=seven+green+apples",
        Origin=PUBLIC,
        Content_Type="application/x-www-form-urlencoded",
    )
    assert (status, headers["location"]) == (303, "/overview")
    assert "; Secure" in headers["set-cookie"]


def test_without_tls_a_cookie_is_not_kept_from_the_browser(server: Server) -> None:
    assert "Secure" not in server.ask(urlsplit(server.participant_url).path).headers["set-cookie"]


@pytest.mark.parametrize("path", ["/_stcore/stream", "/live"])
@pytest.mark.parametrize(
    "origin", ["http://study.example.org", f"http://{INSIDE}", f"{PUBLIC}:8443", f"{PUBLIC}.evil.example"]
)
def test_a_socket_from_any_other_address_is_refused_even_if_host_says_the_same(
    behind: Server, path: str, origin: str
) -> None:
    assert upgrade(behind, path, origin) == 403


def test_streamlit_s_socket_opens_for_the_public_address_though_the_proxy_changed_host(
    behind: Server,
) -> None:
    assert upgrade(behind, "/_stcore/stream", PUBLIC) == 101


def test_a_write_is_taken_from_the_public_address_alone(behind: Server) -> None:
    # 403 is the guard's; 409 comes from behind it.
    cookie, _ = behind.join(starts=False)
    sent = {"Cookie": f"elbowroom_participant={cookie}", "Content_Type": "application/json"}
    assert ask(behind, "/answers", "POST", "{}", Origin=PUBLIC, **sent)[0] == 409
    assert ask(behind, "/answers", "POST", "{}", Origin=f"http://{INSIDE}", **sent)[0] == 403
    assert re.search(f"Origin 'http://{INSIDE}', not '{PUBLIC}'", behind.log.read_text())


def test_the_log_names_who_asked_the_proxy(behind: Server) -> None:
    ask(behind, "/healthz?proxied")
    assert re.search(r'203\.0\.113\.7:0 - "GET /healthz\?proxied', behind.log.read_text())


def test_without_a_public_address_nobody_can_ask_in_another_s_name(server: Server) -> None:
    server.ask("/healthz?forged", headers={"X-Forwarded-For": "203.0.113.7", "X-Forwarded-Proto": "https"})
    log = server.log.read_text()
    assert "/healthz?forged" in log
    assert "203.0.113.7" not in log


@pytest.mark.parametrize(
    ("text", "origin"),
    [
        ("https://study.example.org", "https://study.example.org"),
        ("https://Study.Example.org:443/", "https://study.example.org"),
        ("http://lab-pc:8501", "http://lab-pc:8501"),
        ("http://192.0.2.8:80", "http://192.0.2.8"),
        ("https://bücher.example", "https://xn--bcher-kva.example"),
        ("https://[2001:DB8:0::1]:8443", "https://[2001:db8::1]:8443"),
    ],
)
def test_a_public_address_is_written_as_browsers_write_it(text: str, origin: str) -> None:
    assert parse_public_url(text).origin == origin


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("study.example.org", "begins with neither"),
        ("ftp://study.example.org", "begins with neither"),
        ("https://", "no host name"),
        ("https://example.org/study", "has a path, /study"),
        ("https://example.org?x=1", "more than scheme, host and port"),
        ("https://me:secret@example.org", "more than scheme, host and port"),
        ("https://example.org:99999", "port out of range"),
        ("https://example.org:0", "port out of range"),
        ("https://exa mple.org", "is no host name"),
        ("https://a..b", "is no host name"),
        ("https://[1:2", "invalid ipv6"),
        ("", "begins with neither"),
    ],
)
def test_what_is_no_public_address_is_refused_with_the_reason(text: str, why: str) -> None:
    with pytest.raises(InputError, match=r"^--public-url: ") as refused:
        parse_public_url(text)
    assert why in str(refused.value)


def test_a_wrong_public_address_is_one_line_before_anything_is_written(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "app.cli", "serve", "--store", "s.sqlite", "--public-url", "example.org"]
    result = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=PATIENCE_S)
    assert (result.returncode, result.stdout) == (2, "")
    (line,) = result.stderr.splitlines()
    assert "--public-url: 'example.org'" in line
    assert "https://study.example.org" in line
    assert list(tmp_path.iterdir()) == []


def test_a_server_on_all_addresses_is_shown_by_one_that_others_can_reach() -> None:
    shown = shown_host("0.0.0.0")
    with socket.create_server((shown, 0)) as listener:
        assert listener.getsockname()[0] == shown
    assert shown != "0.0.0.0"
    assert (shown_host("127.0.0.1"), shown_host("::1")) == ("127.0.0.1", "[::1]")

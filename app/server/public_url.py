"""The address by which browsers reach the server, where it isn't the one it listens on: behind a proxy."""

from dataclasses import dataclass
from ipaddress import AddressValueError, IPv6Address
from typing import Literal
from urllib.parse import urlsplit

from data.errors import InputError

_PORTS = {"http": 80, "https": 443}


@dataclass(frozen=True)
class PublicUrl:
    """Scheme, host and port, written as a browser writes them in ``Origin``.

    Attributes
    ----------
    host : str
        In lower case, an international name in ASCII, an IPv6 address in brackets.
    port : int, optional
        None if it is the scheme's own.
    """

    scheme: Literal["http", "https"]
    host: str
    port: int | None = None

    @property
    def origin(self) -> str:
        """What our pages' requests carry as ``Origin``, and what links begin with."""
        return f"{self.scheme}://{self.host}" + ("" if self.port is None else f":{self.port}")

    @property
    def is_secure(self) -> bool:
        """Whether browsers come by TLS."""
        return self.scheme == "https"


def parse_public_url(text: str) -> PublicUrl:
    """The public address, as given on the command line.

    Raises
    ------
    InputError
        If it is more or less than scheme, host and perhaps port.
    """
    try:
        parts = urlsplit(text.strip())
        port = parts.port
    except ValueError as error:
        raise _refusal(text, str(error).lower()) from None
    scheme = parts.scheme
    if scheme not in ("http", "https"):
        raise _refusal(text, "it begins with neither https:// nor http://")
    if "@" in parts.netloc or parts.query or parts.fragment:
        raise _refusal(text, "it has more than scheme, host and port")
    if parts.path not in ("", "/"):
        raise _refusal(text, f"it has a path, {parts.path}; a study needs a host name of its own")
    if port == 0:
        raise _refusal(text, "port out of range 1-65535")
    host = _host(text, parts.hostname or "")
    return PublicUrl("https" if scheme == "https" else "http", host, None if port == _PORTS[scheme] else port)


def _host(text: str, name: str) -> str:
    if ":" in name:
        try:
            return f"[{IPv6Address(name).compressed}]"
        except AddressValueError:
            raise _refusal(text, f"{name} is no IPv6 address") from None
    try:
        host = name.encode("idna").decode("ascii").lower()
    except UnicodeError:
        host = ""
    if not host or not all(label and label.replace("-", "").isalnum() for label in host.split(".")):
        raise _refusal(text, f"{name!r} is no host name" if name else "it has no host name")
    return host


def _refusal(text: str, why: str) -> InputError:
    return InputError(f"--public-url: {text!r}: {why}; write it like https://study.example.org")

"""Look at every page of the site in headless Chromium, at 1366 and 390 pixels, light and dark: `make browser`.

No page may scroll sideways, miss an image, or hold a table column one word wide; the filters of the ledger must work.
The looking is done by `browser.html`, served beside the site, which sends back what it found.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Event, Thread

__all__ = ["look"]

_LOOKER = Path(__file__).with_suffix(".html")
_LEDGER = "results/claims.html"
_NAMES = ("chromium", "chromium-browser", "google-chrome")


class _Handler(SimpleHTTPRequestHandler):
    """The site, the page that looks at it, and what that page found."""

    def __init__(self, *args: object, found: list[str], done: Event, **options: object) -> None:
        self._found, self._done = found, done
        super().__init__(*args, **options)  # type: ignore[arg-type]

    def do_GET(self) -> None:
        if self.path == "/__look":
            self._send(_LOOKER.read_bytes(), "text/html")
        elif self.path == "/__pages":
            site = Path(self.directory)
            pages = sorted(f"/{path.relative_to(site).as_posix()}" for path in site.rglob("*.html"))
            ledger = f"/{_LEDGER}" if (site / _LEDGER).is_file() else None
            self._send(json.dumps({"pages": pages, "ledger": ledger}).encode(), "application/json")
        else:
            super().do_GET()

    def do_POST(self) -> None:
        self._found += json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        self._send(b"", "text/plain")
        self._done.set()

    def _send(self, body: bytes, kind: str) -> None:
        self.send_response(200)
        self.send_header("Content-Type", f"{kind}; charset=utf-8")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_: object) -> None:
        """Say nothing of each request."""


def look(site: Path, browser: str, seconds: float = 600.0) -> list[str]:
    """Return what is wrong with the pages of a site, a line each.

    Raises
    ------
    TimeoutError
        If the browser has not looked at all of them in that time.
    """
    found: list[str] = []
    done = Event()
    handler = partial(_Handler, directory=str(site), found=found, done=done)
    with (
        ThreadingHTTPServer(("127.0.0.1", 0), handler) as server,
        tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile,
    ):
        Thread(target=server.serve_forever, daemon=True).start()
        address = f"http://127.0.0.1:{server.server_address[1]}/__look"
        options = ["--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={profile}"]
        size = ["--window-size=1500,1000", "--remote-debugging-port=0"]  # which keeps it open
        shown = subprocess.Popen(
            [browser, *options, *size, address],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        try:
            if not done.wait(seconds):
                raise TimeoutError(f"the browser has not looked at all pages in {seconds:g} s")
        finally:
            shown.terminate()
            shown.wait()
            server.shutdown()
    return found


def main(site: str) -> int:
    """Look at a site, print what is wrong, and return the exit status."""
    browser = next(filter(None, map(shutil.which, _NAMES)), None)
    if browser is None:
        print(
            f"none of {', '.join(_NAMES)} is installed: apt-get install chromium", file=sys.stderr
        )
        return 2
    if not (Path(site) / "index.html").is_file():
        print(f"{site} holds no site: make report, or make smoke", file=sys.stderr)
        return 2
    found = look(Path(site), browser)
    print("\n".join(found) or f"{site}: nothing is wrong")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

"""A simulated force sensor: it uses the protocol of the real one on the network, and serves its page."""

from __future__ import annotations

import atexit
import threading
from collections.abc import Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Self

from ebac._core import (
    EmulatorCounts,
    EmulatorOptions,
    EmulatorTrouble,
    Grant,
    RdtEmulator,
    RealTime,
    RealTimeMode,
    Setup,
    SharedForce,
)
from ebac._util.wrong_calls import plain_constructor
from ebac.sensor.configuration import MODELS, Rotation, SensorConfig, numbers
from ebac.sensor.page import PAGE

if TYPE_CHECKING:
    from http.server import ThreadingHTTPServer

    from ebac.scenario import Scenario


@plain_constructor
class SimulatedSensor:
    """A simulated force/torque sensor in real time, in a thread of C++. A context manager.

    Parameters
    ----------
    source : SharedForce, Scenario or 3 floats
        The force of the hand on the handle: from a cell that another part of the simulation writes; of
        the scenario's hand that moves its device without power; or steady [N]. In the handle's axes.
    host : str
        Address it takes on this machine.
    port : int
        UDP port, 0 to 65535; 0 takes any free one, see `address`.
    http_port : int or None
        Port of its page, 0 to 65535; None for no page.
    options : EmulatorOptions
        Rate, counts, range, lever and load.
    rotation, sign, model
        How it sits and whose status bits it has, as in `SensorConfig`.
    seed : int
        Of its troubles.

    Raises
    ------
    OSError
        When the address or port cannot be had.
    ValueError, TypeError
        For a value that cannot be.
    """

    def __init__(
        self,
        source: SharedForce | Scenario | Sequence[float] = (0.0, 0.0, 0.0),
        *,
        host: str = "127.0.0.1",
        port: int = 0,
        http_port: int | None = None,
        options: EmulatorOptions | None = None,
        rotation: Rotation | None = None,
        sign: int = 1,
        model: str = "net-ft",
        seed: int = 1,
    ) -> None:
        self.options = options or EmulatorOptions()
        config = SensorConfig(host=host, port=port or 49152, model=model, sign=sign)
        if rotation is not None:
            config = config.replace(rotation=rotation)
        self._config = config
        self._work = RdtEmulator(
            host,
            port,
            _source(source),
            options=self.options,
            rotation=[value for row in config.rotation for value in row],
            sign=sign,
            model=MODELS[model],
            seed=seed,
        )
        self._page: ThreadingHTTPServer | None = None
        if http_port is not None:
            self._page = _page_server(host, http_port, page(self.options, model))
        self._thread: threading.Thread | None = None

    @property
    def address(self) -> tuple[str, int]:
        """Host and UDP port where it is."""
        return self._work.address

    @property
    def http_address(self) -> tuple[str, int] | None:
        """Host and port of its page; None without one."""
        if self._page is None:
            return None
        host, port = self._page.server_address[:2]
        return str(host), int(port)

    @property
    def counts(self) -> EmulatorCounts:
        """What it did so far."""
        return self._work.counts

    @property
    def config(self) -> SensorConfig:
        """Where a client finds it and its page, what its counts are worth, and how it sits."""
        host, port = self.address
        return self._config.replace(
            host="127.0.0.1" if host == "0.0.0.0" else host,
            port=port,
            http_port=self.http_address[1] if self.http_address else 0,
            counts_per_force=self.options.counts_per_force,
            counts_per_torque=self.options.counts_per_torque,
        )

    def inject(self, fault: EmulatorTrouble) -> None:
        """Inject a fault from now on: lost, doubled or swapped packets, silence, or an error status."""
        self._work.set(fault)

    @property
    def grants(self) -> list[Grant]:
        """What its thread asked of the system, and got; nothing before it is started."""
        return self._work.grants

    def start(
        self, mode: RealTimeMode = RealTimeMode.OFF, realtime: RealTime | None = None
    ) -> Self:
        """Put it on the network, once in a life; its thread asks of the system what `realtime` names.

        Raises
        ------
        RuntimeError
            The second time; with `RealTimeMode.ENFORCE` when something is not granted.
        """
        self._work.start(mode, realtime or RealTime())
        atexit.register(self.stop)
        if self._page is not None:
            self._thread = threading.Thread(
                target=self._page.serve_forever, name="page of a sensor", daemon=True
            )
            self._thread.start()
        return self

    def stop(self) -> None:
        """Take it off for good; nothing the second time."""
        self._work.stop()
        if self._page is not None:
            if self._thread is not None:
                self._page.shutdown()
                self._thread.join()
                self._thread = None
            self._page.server_close()
        atexit.unregister(self.stop)

    def __enter__(self) -> Self:
        return self.start()

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.stop()


def page(options: EmulatorOptions, model: str) -> bytes:
    """Return the text of the page: the part of a real one that a client needs."""
    values = {
        "prodname": f"ebac simulated force sensor ({model})",
        "setserial": "simulated",
        "scfgfu": "N",
        "scfgtu": "N-m",
        "cfgcpf": f"{options.counts_per_force:g}",
        "cfgcpt": f"{options.counts_per_torque:g}",
        "comrdte": "Enabled",
        "comrdtrate": f"{options.rate:.0f}",
        "runstat": "00000000",
    }
    body = "".join(f"<{tag}>{text}</{tag}>" for tag, text in values.items())
    return f'<?xml version="1.0"?><netft>{body}</netft>'.encode()


def _source(source: SharedForce | Scenario | Sequence[float]) -> SharedForce | Setup:
    from ebac.scenario import Scenario

    if isinstance(source, SharedForce):
        return source
    if isinstance(source, Scenario):
        return source.setup()
    return SharedForce(list(numbers("source", source, 3)))


def _page_server(host: str, port: int, text: bytes) -> ThreadingHTTPServer:
    from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

    class Page(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            found = self.path.partition("?")[0] == PAGE
            self.send_response(200 if found else 404)
            self.send_header("Content-Type", "text/xml")
            self.send_header("Content-Length", str(len(text) if found else 0))
            self.end_headers()
            if found:
                self.wfile.write(text)

        def log_message(self, format: str, *args: object) -> None:  # noqa: A002
            """Say nothing."""

    try:
        return ThreadingHTTPServer((host, port), Page)
    except OSError as error:
        raise OSError(
            error.errno,
            f"page of a sensor at {host}:{port}: {error.strerror}; give another port with http_port",
        ) from None
    except OverflowError:
        raise ValueError(f"http_port = {port}: must lie in [0, 65535]") from None

"""A network file: which drives are on a bus, and the profile of each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ebac._util.arguments import require_path, unknown, whole
from ebac._util.file_kinds import SCENARIO, kind_of
from ebac._util.wrong_calls import plain_constructor
from ebac.drives.data_sheet import Sheet
from ebac.drives.eds import read_eds
from ebac.drives.errors import ProfileError
from ebac.drives.load import BITRATES, BusLoad, Traffic, bus_load
from ebac.drives.pdo import sync_period
from ebac.drives.profile import Profile, builtin, read_profile, read_source
from ebac.drives.sheets import check_sheet
from ebac.drives.signs_of_life import loop_traffic
from ebac.drives.toml_positions import Source

#: Bit rate of a bus where none is given [bit/s].
_RATE = 1_000_000
#: How the name of a network begins that comes with the package.
BUILT_IN = "the built-in "


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class Node:
    """One drive of a network.

    Parameters
    ----------
    id : int
        Node id, 1 to 127.
    name : str
        Which axis, for people.
    profile : Profile
        What it is to be set to.
    sheet : Sheet or None
        Its maker's electronic data sheet, where the network file names one.
    """

    id: int
    name: str = ""
    profile: Profile
    sheet: Sheet | None = None


@plain_constructor
@dataclass(frozen=True, kw_only=True)
class Network:
    """The drives of one bus.

    Parameters
    ----------
    name : str
        For people.
    nodes : tuple of Node
        The drives.
    bitrate : int
        Bit rate of the bus [bit/s].
    others : tuple of Traffic
        What else comes on the bus again and again.
    """

    name: str
    nodes: tuple[Node, ...]
    bitrate: int = _RATE
    others: tuple[Traffic, ...] = ()

    def bus_load(self) -> BusLoad:
        """Return the worst-case load of the bus by all that loop and drives send again and again.

        SDO is not among it, which a run uses before its loop and after it only, and no emergency, which ends the run.
        """
        periods = [sync_period(node.profile.values) for node in self.nodes]
        frames = [frame for node in self.nodes for frame in node.profile.traffic(node.id)]
        sync = [Traffic(name="SYNC", size=0, rate=1 / min(periods))] if periods else []
        signs = loop_traffic([(node.id, node.profile) for node in self.nodes])
        return bus_load([*sync, *frames, *signs, *self.others], bitrate=self.bitrate)

    def check_load(self) -> str | None:
        """Return a warning when the bus is busier than comfortable.

        Raises
        ------
        ProfileError
            When it is so busy that nothing else gets through.
        """
        load = self.bus_load()
        if load.refused:
            raise ProfileError(f"{self.name}: {load.describe()}")
        return f"{self.name}: {load.describe()}" if load.warned else None


def load(name: str | Path, *, nodes: Sequence[int] = (), bitrate: int | None = None) -> Network:
    """Return a network from a network file, or from a profile for the nodes given.

    Parameters
    ----------
    name : str or Path
        A file, or a name of `builtin()`.
    nodes : sequence of int
        Of a network file: only these. Of a profile: the nodes it is for.
    bitrate : int, optional
        Of the bus [bit/s], one of `BITRATES`; default: that of the file, or 1 000 000 where it has none.

    Raises
    ------
    ProfileError
        For what cannot be; the message names file, line, key, value, unit, range and remedy.
    """
    require_path(name, "ebac.drives.load", "the path of a file or the name of a profile")
    source = read_source(name)
    nodes = [whole("node", node) for node in nodes]
    for node in nodes:
        if not 1 <= node <= 127:
            raise ProfileError(f"node = {node}: must lie in [1, 127]")
    if bitrate is not None and (wrong := _no_rate(bitrate)):
        raise ProfileError(f"bitrate = {wrong}")
    called = f"{BUILT_IN}{name}" if str(name) in builtin() else source.name
    if "node" in source.table:
        network = _network(source, called, bitrate)
        return _only(network, nodes)
    _refuse_configuration(source)
    profile = read_profile(source)
    if not nodes:
        raise ProfileError(
            f"{source.name}: is a profile for any node: a configuration of `ebac run` needs a network file, whose "
            "[[node]] tables name it (`ebac drive profile joystick` prints one); a command of one drive takes --node"
        )
    chosen = tuple(Node(id=node, profile=profile) for node in dict.fromkeys(nodes))
    return Network(name=called, nodes=chosen, bitrate=int(bitrate or _RATE))


def _refuse_configuration(source: Source) -> None:
    """Refuse the configuration of a run, and name the file of its drives."""
    kind = kind_of(source.table)
    if kind == SCENARIO:
        raise ProfileError(
            f"{source.name}: is {kind}, which names no drives; give a network file or a profile of drives: `ebac drive "
            "profile` lists those that are built in"
        )
    bus = source.table.get("bus")
    found = bus.get("drives") if isinstance(bus, Mapping) else None
    if found is None and {"device", "environment", "law"}.isdisjoint(source.table):
        return
    found = "joystick" if found is None else str(found)
    beside = Path(source.name).parent / found
    raise ProfileError(
        f"{source.name}: is a configuration of `ebac run`; give the network file or profile of its drives, "
        f"which it names in bus.drives: {beside if beside.is_file() else found}"
    )


def _only(network: Network, nodes: Sequence[int]) -> Network:
    there = [node.id for node in network.nodes]
    for node in nodes:
        if node not in there:
            ids = ", ".join(str(one) for one in there)
            raise ProfileError(f"node = {node}: {network.name} has no such node; it has: {ids}")
    kept = tuple(node for node in network.nodes if not nodes or node.id in nodes)
    # The others are on the bus all the same, with their share of it.
    rest = [node for node in network.nodes if node not in kept]
    frames = [frame for node in rest for frame in node.profile.traffic(node.id)]
    return Network(
        name=network.name,
        nodes=kept,
        bitrate=network.bitrate,
        others=(*network.others, *frames),
    )


def _no_rate(given: object) -> str:
    """Return what is wrong with a bit rate, with its value in front; "" for one of CiA 301."""
    if not isinstance(given, bool) and given in BITRATES:
        return ""
    return f"{given!r} bit/s: must be one of {', '.join(str(rate) for rate in BITRATES)} bit/s"


def _network(source: Source, called: str, asked: int | None) -> Network:
    known = ["about", "bus", "node"]
    for title in source.table:
        if title not in known:
            raise source.refuse((title,), unknown(title, title, known))
    bus = source.table.get("bus", {})
    if not isinstance(bus, Mapping):
        raise source.refuse(("bus",), f"bus = {bus!r}: must be a table")
    for key in bus:
        if key not in ("bitrate", "other"):
            raise source.refuse(("bus", key), unknown(f"bus.{key}", key, ["bitrate", "other"]))
    bitrate = bus.get("bitrate", asked or _RATE)
    if wrong := _no_rate(bitrate):
        raise source.refuse(("bus", "bitrate"), f"bus.bitrate = {wrong}")
    if asked not in (None, bitrate):
        raise source.refuse(
            ("bus", "bitrate"),
            f"bus.bitrate = {bitrate} bit/s, but bitrate = {asked} bit/s (--bitrate) is given: correct the one that is "
            "not the bit rate of the bus, or leave it out",
        )
    others = bus.get("other", [])
    if not isinstance(others, list):
        raise source.refuse(("bus", "other"), "bus.other: must be written [[bus.other]]")
    network = Network(
        name=called,
        nodes=_nodes(source),
        bitrate=int(bitrate),
        others=tuple(_other(source, i, item) for i, item in enumerate(others)),
    )
    check_sheet(network)
    return network


def _nodes(source: Source) -> tuple[Node, ...]:
    tables = source.table["node"]
    tables_only = isinstance(tables, list) and all(isinstance(item, Mapping) for item in tables)
    if not tables_only or not tables:
        raise source.refuse(("node",), "node: must be written [[node]], once for each drive")
    nodes: list[Node] = []
    for i, table in enumerate(tables):
        found = table.get("id")
        at = ("node", i, "id") if "id" in table else ("node", i)
        if isinstance(found, bool) or not isinstance(found, int) or not 1 <= found <= 127:
            raise source.refuse(
                at, f"node[{i}].id = {found!r}: must be a whole number in [1, 127], the drive's own"
            )
        if found in [node.id for node in nodes]:
            raise source.refuse(
                at, f"node[{i}].id = {found}: is that of another node; must be unique, 1 to 127"
            )
        name = table.get("name", "")
        if not isinstance(name, str):
            raise source.refuse(("node", i, "name"), f"node {found}: name = {name!r}: must be text")
        of_node = replace(source, of=f"node {found}: ")
        profile = read_profile(of_node, base=_base(source, i, table), at=("node", i))
        sheet = _sheet(source, i, table) if "eds" in table else None
        nodes.append(Node(id=found, name=name, profile=profile, sheet=sheet))
    for i, node in enumerate(nodes):
        if any(node.id == other.profile.values["heartbeat.master"] for other in nodes):
            raise source.refuse(
                ("node", i, "id"),
                f"node[{i}].id = {node.id}: is heartbeat.master, the loop's own id: choose another",
            )
        first, own = (int(one.profile.values["heartbeat.master"]) for one in (nodes[0], node))
        if own != first:
            raise source.refuse(
                ("node", i, "heartbeat", "master"),
                f"node {node.id}: heartbeat.master = {own}, that of node {nodes[0].id} is {first}: the loop sends one "
                "heartbeat, and a drive that watches another is not stopped when the loop dies; give all the same",
            )
    return tuple(nodes)


def _sheet(source: Source, i: int, table: Mapping[str, Any]) -> Sheet:
    name = table["eds"]
    if not isinstance(name, str):
        raise source.refuse(
            ("node", i, "eds"),
            f"node {table['id']}: eds = {name!r}: must be the name of the drive's data sheet, an EDS or DCF file",
        )
    try:
        return read_eds(Path(source.name).parent / name)
    except ProfileError as error:
        raise source.refuse(("node", i, "eds"), f"node {table['id']}: eds: {error}") from None


def _base(source: Source, i: int, table: Mapping[str, Any]) -> Profile:
    name = table.get("profile")
    if not isinstance(name, str):
        at = ("node", i, "profile") if "profile" in table else ("node", i)
        raise source.refuse(
            at,
            f"node {table['id']}: profile = {name!r}: must be the name of a profile, or of its file",
        )
    beside = Path(source.name).parent / name
    try:
        base = read_source(beside if beside.is_file() else name)
    except ProfileError as error:
        raise source.refuse(
            ("node", i, "profile"), f"node {table['id']}: profile: {error}"
        ) from None
    if "node" in base.table:
        raise source.refuse(
            ("node", i, "profile"),
            f"node {table['id']}: profile = {name!r}: is itself a network file",
        )
    return read_profile(base)


def _other(source: Source, i: int, table: Any) -> Traffic:
    path = ("bus", "other", i)
    size, rate = (
        table.get(key) if isinstance(table, Mapping) else None for key in ("size", "rate")
    )
    if isinstance(size, bool) or not isinstance(size, int) or not 0 <= size <= 8:
        raise source.refuse(
            path, f"bus.other[{i}].size = {size!r} bytes: must be a whole number in [0, 8]"
        )
    if isinstance(rate, bool) or not isinstance(rate, (int, float)) or not 0 < rate <= 1e5:
        raise source.refuse(path, f"bus.other[{i}].rate = {rate!r} Hz: must lie in (0, 100000] Hz")
    return Traffic(name=str(table.get("name", f"other {i}")), size=size, rate=float(rate))

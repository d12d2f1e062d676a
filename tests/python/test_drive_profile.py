"""Profiles and network files: what they set, and how they refuse, with file and line."""

import dataclasses
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ebac
from ebac import drives
from ebac._util.toml_lines import line_of
from ebac.drives.load import BITRATES
from ebac.drives.objects import ENTRIES, find, known, mapped
from ebac.drives.pdo import read_pdo
from ebac.drives.profile import read_profile, read_source
from ebac.drives.profile_fields import KEYS
from ebac.drives.settings import groups, writes
from ebac.drives.stall import hold_time
from ebac.drives.toml_positions import Source
from ebac.hardware import profile_for

COPLEY = read_source("copley-accelnet").text


def refused(text: str, *, name: str = "my.toml") -> str:
    with pytest.raises(drives.ProfileError) as caught:
        read_profile(Source(name=name, text=text))
    return str(caught.value)


# --- where things stand ---

KEY = st.text("abc", min_size=1, max_size=3)
SCALAR = st.integers() | st.booleans() | st.floats(allow_nan=False) | st.text(max_size=20)
TABLE = st.recursive(
    SCALAR | st.lists(SCALAR, max_size=3),
    lambda inner: st.dictionaries(KEY, inner, max_size=3) | st.lists(inner, max_size=2),
    max_leaves=8,
)


@given(table=st.dictionaries(KEY, TABLE, max_size=4), blank=st.integers(0, 3))
def test_a_key_stands_where_it_was_written(table: dict[str, Any], blank: int) -> None:
    import tomli_w

    text = "# a comment\n" * blank + tomli_w.dumps(table, multiline_strings=True)
    for name, value in table.items():
        line = line_of(text, (name,))
        assert line is not None
        said = text.split("\n")[line - 1]
        assert re.match(rf"(\[+)?{name}\b", said), (name, said)
        if isinstance(value, dict):
            for inner in value:
                at = line_of(text, (name, inner))
                assert at is not None
                assert inner in text.split("\n")[at - 1]


def test_a_value_of_several_lines_stands_where_it_begins() -> None:
    text = '# one\na = [\n  1,\n  2,\n]\nb = """\nc = 1\n"""\n[t]\nc = { d = 1 }\n[[n]]\ne=1\n[[n]]\ne=2\n'
    lines = {("a",): 2, ("a", 1): 2, ("b",): 6, ("t",): 9, ("t", "c", "d"): 10, ("n", 1, "e"): 14}
    assert {path: line_of(text, path) for path in lines} == lines
    assert line_of(text, ("c",)) is None


# --- messages ---


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("torque_constant = 0.0538", "torque_constant = -1", 6,
         "motor.torque_constant = -1 N m/A: must lie in [1e-05, 100] N m/A; see the motor's data sheet"),
        ("torque_constant = 0.0538", "torqe_constant = 0.0538", 6,
         "motor.torqe_constant: no such name, did you mean 'torque_constant'; there are: object, torque_constant"),
        ("torque_constant = 0.0538", "torque_constant = '0.05'", 6,
         'motor.torque_constant = "0.05": must be a number in N m/A'),
        ("torque_constant = 0.0538", "torque_constant = true", 6,
         "motor.torque_constant = true: must be a number in N m/A"),
        ("torque_constant = 0.0538", "torque_constant = 54", 13,
         "limits.rated_current = 0.985 A: must be within 2 % of limits.rated_torque / motor.torque_constant = 0.053 N "
         "m / 54 N m/A = 0.0009815 A, the current of the rated torque, or every force is wrong; give 0.0009815, or"),
        ("rated_current = 0.985", "rated_current = 1.01", 13,
         "limits.rated_current = 1.01 A: must be within 2 % of"),
        ("peak_torque = 0.212", "peak_torque = 0.000012", 8,
         "motor.peak_torque = 1.2e-05 N m: the drive holds 1 raw units instead of 1.2, more than 1 % off; one unit is "
         "1e-05 N m: give 1e-05 N m, the nearest that it can hold; or, where the drive counts in smaller units, name "
         "motor.peak_torque under `without`"),
        ("torque_constant = 0.0538", "torque_constant = nan", 6,
         "motor.torque_constant = nan N m/A: must lie in"),
        ("counts_per_turn = 1024", "counts_per_turn = 10.5", 9,
         "motor.counts_per_turn = 10.5: must be a whole number in counts; edges the drive counts"),
        ("[motor]", "[moter]", 4,
         "moter: no such name, did you mean 'motor'; there are: about, vendor, pdo, objects, without, motor"),
        ('"0x2383"  ', '"0x2384"', 5,
         'motor.object = "0x2384": must be "0x2383" or "0x6410"; older Copley firmware'),
        ("continuous_torque = 0.053", "continuous_torque = 0.06", 7,
         "motor.continuous_torque = 0.06 N m: differs from limits.rated_torque by more than 1 %"),
        ("rated_current = 0.985", "", 15,
         "limits.max_current = 3.94 A: is written to the drive in per mille of limits.rated_current, which is not "
         "given: give limits.rated_current = 0.9851, which is"),
        ("max_current = 3.94", "max_current = 200.0", 15,
         "limits.max_current = 200 A: is written to the drive in per mille of limits.rated_current, at most 65535: "
         "must be at most 64.55 A"),
        ('mode = "cyclic synchronous torque"', 'mode = "profile torque"', 18,
         "torque.mode = 'profile torque': profile torque ramps by torque.slope: give torque.slope, steep"),
        ('mode = "cyclic synchronous torque"', "mode = 10", 18,
         'torque.mode = 10: must be "cyclic synchronous torque" or "profile torque"; profile torque for firmware'),
        ("period = 1e-3", "period = 2.0", 26, "sync.period = 2 s: must lie in [0.0001, 1] s; 1e-3 s for a 1 kHz"),
        ("on = true", "on = 1", 29, "emcy.on = 1: must be true or false; a fault must be reported"),
        ("master = 127", "master = 128", 34, "heartbeat.master = 128: must lie in [1, 127]; node id of the loop"),
        ("quick_stop = 2 ", "quick_stop = 9 ", 23, "drive.quick_stop = 9: must lie in [0, 8]; CiA 402-2, 0x605A"),
        ("[pdo.rpdo1]", "[pdo.rpdo5]", 39, "pdo.rpdo5: no such name, did you mean 'rpdo"),
        ('"controlword", ', '"controlwort", ', 40,
         "pdo.rpdo1.objects[0]: object 'controlwort': no such name, did you mean 'controlword'"),
        ('"statusword", ', '"device_name", ', 45, "pdo.tpdo1.objects[0]: object 'device_name': is no number"),
        ('"statusword", ', '"position", "velocity", ', 45, "pdo.tpdo1.objects: 14 bytes, a PDO carries at most 8"),
        ("type = 1\n\n", "type = 241\n\n", 42, "pdo.rpdo1.type = 241: must be 0 to 240 (with SYNC) or 254, 255"),
        ("type = 1\n\n", "inhibit = 1e-3\n\n", 42, "pdo.rpdo1.inhibit = 0.001 s: only what the drive sends has one"),
        ('others = "off"', 'others = "on"', 37, "pdo.others = 'on': must be \"off\" or \"keep\""),
    ],
)  # fmt: skip
def test_a_wrong_profile_is_refused_with_its_line(
    old: str, new: str, line: int, message: str
) -> None:
    assert old in COPLEY
    said = refused(COPLEY.replace(old, new, 1))
    assert said.startswith(f"my.toml, line {line}: {message}"), said


@pytest.mark.parametrize(
    "text", ["", "# later\n", 'about = "x"\n', "[motor]\n[pdo]\n", "without = []\n"]
)
def test_a_profile_that_sets_nothing_is_refused(text: str, tmp_path: Path) -> None:
    """Its drive was simulated without PDOs, or blamed for a torque that it would hold."""
    file = tmp_path / "my.toml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(
        drives.ProfileError, match=r"my\.toml: sets nothing: a profile needs tables"
    ):
        drives.load(file, nodes=[1])
    network = tmp_path / "net.toml"
    network.write_text('[[node]]\nid = 1\nprofile = "my.toml"\n', encoding="utf-8")
    with pytest.raises(drives.ProfileError, match=r"my\.toml: sets nothing"):
        drives.load(network)


def test_an_event_pdo_without_inhibit_time_would_flood_the_bus() -> None:
    text = '[pdo.tpdo1]\nobjects = ["statusword"]\ntype = 255\n'
    assert "line 1: pdo.tpdo1.type = 255: an event may come at any rate" in refused(text)
    source = Source(name="a", text=f"{text}inhibit = 0.01\nevent = 0.5\n")
    pdo = read_pdo(source, "tpdo1", source.table["pdo"]["tpdo1"])
    assert pdo.traffic(1, 1e-3).rate == pytest.approx(100)


VALUES = SCALAR | st.lists(SCALAR, max_size=2) | st.dictionaries(KEY, SCALAR, max_size=2)
PLACES = st.sampled_from(
    [("about",), ("motor",), ("motor", "torque_constant"), ("torque", "mode"), ("emcy", "on"), ("pdo",),
     ("pdo", "others"), ("pdo", "tpdo1"), ("pdo", "tpdo1", "objects"), ("pdo", "tpdo1", "type"),
     ("pdo", "tpdo1", "event"), ("node",), ("node", 0), ("node", 0, "id"), ("node", 0, "profile"),
     ("node", 0, "name"), ("bus",), ("bus", "bitrate"), ("bus", "other"), ("sync", "period")]
)  # fmt: skip


@given(place=PLACES, value=VALUES)
def test_whatever_stands_in_a_file_is_taken_or_refused_by_its_place(
    place: tuple[str | int, ...], value: Any, tmp_path_factory: pytest.TempPathFactory
) -> None:
    import tomli_w

    name = "joystick" if place[0] in ("node", "bus") else "copley-accelnet"
    table: Any = read_source(name).table
    at = table
    for part in place[:-1]:
        at = at[part]
    at[place[-1]] = value
    file = tmp_path_factory.mktemp("fuzz") / "any.toml"
    file.write_text(tomli_w.dumps(table), encoding="utf-8")
    try:
        drives.load(file, nodes=[] if name == "joystick" else [1]).bus_load()
    except drives.ProfileError as error:
        assert str(error).startswith(str(file)) or "profile" in str(place)  # noqa: PT017


def test_values_of_numpy_become_plain_ones() -> None:
    known = drives.load("copley-accelnet", nodes=[1]).nodes[0].profile
    changed = known.replace(motor__peak_torque=np.float32(0.125), heartbeat__master=np.int64(100))
    assert changed == known.replace(motor__peak_torque=0.125, heartbeat__master=100)
    assert {type(value) for value in changed.values.values()} <= {int, float, str, bool}
    with pytest.raises(drives.ProfileError, match="torque_constant = true: must be a number"):
        known.replace(motor__torque_constant=True)


def test_what_is_no_toml_says_so() -> None:
    assert refused("a = = 1").startswith("my.toml: not a TOML document: ")


DRIVE = '[[node]]\nid = {}\nprofile = "copley-accelnet"\n'
NETWORK = f"[bus]\nbitrate = 1000000\n{DRIVE.format(1)}{DRIVE.format(2)}"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("bitrate = 1000000", "bitrate = 1000001", "line 2: bus.bitrate = 1000001 bit/s: must be one of 10000,"),
        ("id = 1", "id = 0", "line 4: node[0].id = 0: must be a whole number in [1, 127], the drive's own"),
        ("id = 1", "id = 127", "line 4: node[0].id = 127: is heartbeat.master, the loop's own id: choose another"),
        ("id = 2", "id = 1", "line 7: node[1].id = 1: is that of another node; must be unique, 1 to 127"),
        ("id = 2", "id = 2\nheartbeat.master = 100",
         "line 8: node 2: heartbeat.master = 100, that of node 1 is 127: the loop sends one heartbeat"),
        ("id = 1\nprofile", "id = 1\nname", "line 3: node 1: profile = None: must be the name of a profile"),
        ('id = 1\nprofile = "copley-accelnet"', 'id = 1\nprofile = "joystick"',
         "line 5: node 1: profile = 'joystick': is itself a network file"),
        ("id = 2", "id = 2\nmotor.torque_constant = -1", "line 8: node 2: motor.torque_constant = -1 N m/A"),
        ("id = 2", "id = 2\nmoter.torque_constant = 1", "line 8: node 2: moter: no such name, did you mean 'motor'"),
        ("[bus]", "[buss]", "line 1: buss: no such name, did you mean 'bus'"),
        ("[[node]]\nid = 1", "[[bus.other]]\nsize = 9\nrate = 1.0\n[[node]]\nid = 1",
         "line 3: bus.other[0].size = 9 bytes: must be a whole number in [0, 8]"),
    ],
)  # fmt: skip
def test_a_wrong_network_file_is_refused_with_its_line(
    old: str, new: str, message: str, tmp_path: Path
) -> None:
    file = tmp_path / "net.toml"
    file.write_text(NETWORK.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(drives.ProfileError) as caught:
        drives.load(file)
    assert str(caught.value).startswith(f"{file}, {message}"), caught.value


def test_a_network_file_without_a_drive_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "net.toml"
    file.write_text("node = []\n", encoding="utf-8")
    with pytest.raises(
        drives.ProfileError, match=r"line 1: node: must be written \[\[node\]\], once"
    ):
        drives.load(file)


def test_a_bit_rate_that_is_given_is_that_of_a_file_without_one(tmp_path: Path) -> None:
    file = tmp_path / "net.toml"
    file.write_text(NETWORK.replace("bitrate = 1000000\n", ""), encoding="utf-8")
    assert drives.load(file).bitrate == 1_000_000
    slow = drives.load(file, bitrate=np.int64(125_000), nodes=[1])  # type: ignore[arg-type]
    assert slow.bitrate == 125_000
    with pytest.raises(drives.ProfileError, match="of 125 kbit/s, worst case: refused over 90 %"):
        slow.check_load()
    for name in (file, "copley-accelnet"):
        with pytest.raises(drives.ProfileError, match=r"^bitrate = 0 bit/s: must be one of 10000,"):
            drives.load(name, bitrate=0, nodes=[1])
    file.write_text(NETWORK, encoding="utf-8")
    assert drives.load(file, bitrate=1_000_000).bitrate == 1_000_000
    with pytest.raises(drives.ProfileError) as caught:
        drives.load(file, bitrate=125_000)
    assert str(caught.value) == (
        f"{file}, line 2: bus.bitrate = 1000000 bit/s, but bitrate = 125000 bit/s (--bitrate) is given: correct the "
        "one that is not the bit rate of the bus, or leave it out"
    )


def test_a_name_that_is_no_file_lists_what_there_is() -> None:
    with pytest.raises(drives.ProfileError, match="no profile of that name; there are: copley-acc"):
        drives.load("joistick")
    with pytest.raises(drives.ProfileError, match="`ebac drive profile generic-cia402` prints one"):
        drives.load("joistick")


# --- what comes with the package ---


@pytest.mark.parametrize("name", drives.builtin())
def test_every_profile_of_the_package_is_right_and_fits_a_bus(name: str) -> None:
    whole = {"handle": 1, "joystick": 2, "joystick-3": 3}
    network = drives.load(name, nodes=() if name in whole else (1, 2))
    assert [node.id for node in network.nodes] == [1, 2, 3][: whole.get(name, 2)]
    share = {"handle": 0.28, "joystick-3": 0.6}.get(name, 0.52)
    assert network.bus_load().share == pytest.approx(share, abs=0.015)
    assert network.check_load() is None
    for node in network.nodes:
        assert node.profile.about
        for group in groups(node.profile, node.id):
            for one in group.settings:
                one.object.encode(one.value)  # fits its type


def test_a_node_changes_keys_of_its_profile_and_no_other(tmp_path: Path) -> None:
    file = tmp_path / "net.toml"
    text = NETWORK.replace(
        "id = 2", "id = 2\nmotor.torque_constant = 0.06\nlimits.rated_current = 0.8833"
    )
    file.write_text(text, encoding="utf-8")
    first, second = drives.load(file).nodes
    assert first.profile.values["motor.torque_constant"] == 0.0538
    assert second.profile.values["motor.torque_constant"] == 0.06
    assert second.profile.pdos == first.profile.pdos
    (chosen,) = drives.load(file, nodes=[2]).nodes
    assert chosen == second
    assert drives.load(file, nodes=[2]).bus_load().share == pytest.approx(
        drives.load(file).bus_load().share
    )


def test_a_profile_in_python_is_checked_as_one_in_a_file() -> None:
    profile = drives.load("copley-accelnet", nodes=[1]).nodes[0].profile
    changed = profile.replace(motor__torque_constant=0.06, limits__rated_current=0.8833)
    assert changed.values["motor.torque_constant"] == 0.06
    with pytest.raises(drives.ProfileError, match=r"motor.torque_constant = -1 N m/A: must lie in"):
        profile.replace(motor__torque_constant=-1)
    with pytest.raises(drives.ProfileError, match=r"did you mean 'motor\.torque_constant'"):
        profile.replace(motor__torqe_constant=1)
    with pytest.raises(drives.ProfileError, match="two things"):
        profile.replace(limits__rated_torque=0.06)


@pytest.mark.parametrize("constant", [0.0538 * 1.5, 0.0538 / 2**0.5, 0.0538 * 2.45])
def test_a_torque_constant_of_peak_or_effective_amperes_is_taken(constant: float) -> None:
    profile = drives.load("copley-accelnet", nodes=[1]).nodes[0].profile
    assert profile.replace(motor__torque_constant=constant)


def test_the_page_says_how_long_each_profile_holds_a_torque() -> None:
    page = Path(__file__).parents[2] / "docs" / "how-to" / "set_up_drives.md"
    told: dict[str, float] = {}
    for row in re.finditer(r"^\| (`.*?) \| .* \| (\d+) ms \|$", page.read_text("utf-8"), re.M):
        told |= dict.fromkeys(re.findall(r"`(.+?)`", row[1]), float(row[2]))
    for name in drives.builtin():
        if "node" not in read_source(name).table:
            (node,) = drives.load(name, nodes=[1]).nodes
            assert told.pop(name) == pytest.approx(1e3 * hold_time(node.profile)), name
    assert not told


# --- raw numbers ---


def raw(name: str, **values: Any) -> dict[str, int]:
    profile = drives.load(name, nodes=[3]).nodes[0].profile.replace(**values)
    return {s.object.name: s.value for g in groups(profile, 3) for s in g.settings}


def test_the_paper_s_motor_in_raw_numbers() -> None:
    """I = 0.001 T Tc / Ts, eq. (1): 500 per mille are 0.4926 A."""
    numbers = raw("copley-accelnet")
    assert numbers["motor_torque_constant"] == 5380
    assert numbers["motor_continuous_torque"] == 5300
    assert pytest.approx(0.4926, abs=5e-5) == 0.001 * 500 * 5300 / 5380
    assert numbers["rated_torque"] == 53
    assert numbers["rated_current"] == 985
    assert (numbers["max_torque"], numbers["max_current"]) == (4000, 4000)
    assert (numbers["mode"], numbers["desired_state"]) == (10, 30)
    assert numbers["sync_period"] == 1000
    assert numbers["heartbeat_consumer"] == 127 << 16 | 100
    assert numbers["emcy_cob_id"] == 0x83
    assert (numbers["rpdo1_cob_id"], numbers["tpdo1_cob_id"]) == (0x203, 0x183)
    assert (numbers["rpdo1_entry1"], numbers["rpdo1_entry2"]) == (0x60400010, 0x60710010)
    assert [numbers[f"tpdo1_entry{i}"] for i in (1, 2, 3)] == [0x60410010, 0x60640020, 0x60770010]
    assert numbers["tpdo4_cob_id"] == 1 << 31


def test_whose_heartbeat_a_drive_watches_is_shown_in_words() -> None:
    consumer = find("heartbeat_consumer")
    assert consumer.show(127 << 16 | 300) == "node 127, 300 ms"
    assert consumer.show(0) == "none"


def test_older_firmware_has_its_motor_data_elsewhere_and_ramps() -> None:
    numbers = raw("copley-xenus")
    assert numbers["motor_torque_constant_old"] == 5380
    assert "motor_torque_constant" not in numbers
    assert numbers["mode"] == 4
    assert numbers["torque_slope"] == pytest.approx(1000 * 1000 / 0.053, rel=1e-6)


@given(data=st.data())
def test_raw_numbers_are_within_one_per_cent_of_what_was_asked(data: st.DataObject) -> None:
    key = data.draw(st.sampled_from([k for k in KEYS if k.sets and not k.choices and not k.per]))
    value = data.draw(
        st.integers(int(key.low), int(key.high)) if key.whole else st.floats(key.low, key.high)
    )
    assert key.check(value) is None
    try:
        assert key.raw(value, {}) * key.scale == pytest.approx(value, rel=0.0101)
    except ValueError as error:
        assert "more than 1 % off" in str(error)  # noqa: PT017


@given(value=st.integers(-(2**33), 2**33), data=st.data())
def test_an_object_takes_what_fits_and_gives_it_back(value: int, data: st.DataObject) -> None:
    obj = data.draw(st.sampled_from([o for o in known().values() if o.kind != "str"]))
    try:
        assert obj.decode(obj.encode(value)) == value
        assert len(obj.encode(value)) * 8 == obj.bits
    except ValueError as error:
        assert obj.name in str(error)  # noqa: PT017
        signed = obj.kind.startswith("i")
        assert not -(2 ** (obj.bits - 1)) * signed <= value < 2 ** (obj.bits - signed)


def test_names_and_indices_of_objects_are_unique() -> None:
    table = known()
    assert len({o.key for o in table.values()}) == len(table)
    assert drives.find(0x6041) is drives.find("statusword") is drives.find((0x6041, 0))
    assert drives.find((0x1A00, 8)).name == f"tpdo1_entry{ENTRIES}"
    assert mapped(0x60710010) == "target_torque"
    with pytest.raises(KeyError, match="did you mean 'statusword'"):
        drives.find("statuswort")
    with pytest.raises(KeyError, match="index must lie in"):
        drives.find(0x10000)


# --- the safe order ---


def held_by(number: int, cob: int, entries: list[int]) -> dict[tuple[int, int], bytes]:
    held = {(0x1800 + number, 1): cob.to_bytes(4, "little"), (0x1800 + number, 2): b"\xff"}
    held |= {(0x1800 + number, sub): bytes(2) for sub in (3, 5)}
    held[0x1A00 + number, 0] = bytes([len(entries)])
    padded = [*entries, *[0] * (ENTRIES - len(entries))]
    return held | {(0x1A00 + number, i): e.to_bytes(4, "little") for i, e in enumerate(padded, 1)}


@given(
    objects=st.lists(
        st.sampled_from(["statusword", "actual_torque", "mode_display"]), min_size=1, max_size=4
    ),
    before=st.lists(st.integers(1, 2**32 - 1), max_size=8),
    on=st.booleans(),
)
def test_a_pdo_is_written_off_empty_filled_counted_on(
    objects: list[str], before: list[int], on: bool
) -> None:
    profile = drives.Profile(
        name="p", values={}, pdos=(drives.Pdo(name="tpdo1", objects=tuple(objects)),)
    )
    (group,) = [g for g in groups(profile, 1) if g.name == "tpdo1"]
    cob = 0x40000181 | (0 if on else 1 << 31)
    steps = [
        (s.object.name.removeprefix("tpdo1_"), s) for s in writes(group, held_by(0, cob, before))
    ]
    names = [name for name, _ in steps]
    entries = [f"entry{i}" for i in range(1, len(objects) + 1)]
    assert names == ["cob_id", "type", "count", *entries, "count", "cob_id"]
    first, last = (int.from_bytes(steps[i][1].data, "little") for i in (0, -1))
    assert (first, last) == (0xC0000181, 0x40000181)
    assert steps[2][1].data == b"\x00"


# --- bus load ---


def test_the_load_of_the_joystick_is_515_us_of_each_millisecond() -> None:
    load = drives.load("joystick").bus_load()
    cyclic = [t for t in load.traffic if "heartbeat" not in t.name]
    assert sum(t.bits for t in cyclic) == 515
    assert drives.frame_bits(0) == 55
    assert drives.frame_bits(8) == 135


def guarded(node: drives.Node, seconds: float) -> drives.Node:
    """The node with node guarding in place of heartbeats."""
    values = {**node.profile.values, "heartbeat.guard": seconds, "heartbeat.consumer": 0.0}
    return dataclasses.replace(node, profile=dataclasses.replace(node.profile, values=values))


def beside_pdos(network: drives.Network) -> float:
    """Bits a second."""
    frames = network.bus_load().traffic
    return sum(t.bits * t.rate for t in frames if t.name != "SYNC" and "pdo" not in t.name)


def test_the_load_has_every_sign_of_life_of_loop_and_drives() -> None:
    network = drives.load("joystick")
    consumer = min(float(one.profile.values["heartbeat.consumer"]) for one in network.nodes)
    assert beside_pdos(network) == pytest.approx(65 * (2 / 0.1 + 10 / consumer))
    both = dataclasses.replace(network, nodes=tuple(guarded(one, 0.1) for one in network.nodes))
    assert beside_pdos(both) == pytest.approx(2 * 2 * 65 * 5 / 0.1)  # 2 requests and 2 answers
    first, second = network.nodes
    # A loop that guards one drive sends its requests to all.
    mixed = dataclasses.replace(network, nodes=(guarded(first, 0.1), second))
    expected = 65 * (2 * 50 + 50 + 1 / 0.1 + 10 / consumer)
    assert beside_pdos(mixed) == pytest.approx(expected)


@given(
    sizes=st.lists(st.integers(0, 8), max_size=20),
    rate=st.floats(1, 5000),
    bitrate=st.sampled_from(BITRATES),
)
def test_load_adds_up_and_is_judged(sizes: list[int], rate: float, bitrate: int) -> None:
    frames = [drives.Traffic(name="f", size=n, rate=rate) for n in sizes]
    load = drives.bus_load(frames, bitrate=bitrate)
    assert load.share == pytest.approx(sum(drives.frame_bits(n) for n in sizes) * rate / bitrate)
    assert load.refused == (load.share > 0.9)
    assert load.warned == (load.share > 0.7)
    assert ("refused" in load.describe()) == load.refused


def test_a_bus_too_busy_is_refused_and_a_busy_one_warned_of(tmp_path: Path) -> None:
    file = tmp_path / "net.toml"
    other = "[[bus.other]]\nname = 'force sensor'\nsize = 8\nrate = 2000.0\n"
    text = read_source("joystick").text
    file.write_text(text + other, encoding="utf-8")
    network = drives.load(file)
    assert network.bus_load().share == pytest.approx(0.793, abs=1e-3)
    assert "79 %" in (network.check_load() or "")
    file.write_text(text.replace("1_000_000", "500_000"), encoding="utf-8")
    with pytest.raises(drives.ProfileError, match="refused over 90 %; raise the bit rate"):
        drives.load(file).check_load()


@pytest.mark.parametrize("size", [-1, 9])
def test_a_frame_has_eight_bytes_at_most(size: int) -> None:
    with pytest.raises(ValueError, match=f"size = {size} bytes"):
        drives.frame_bits(size)


def derived(line: str, rest: str = "[limits]\nrated_current = 1.25\n") -> drives.Profile:
    return read_profile(Source(name="mine.toml", text=f'{rest}[objects]\n"0x3001:1" = {line}\n'))


def test_an_object_may_follow_from_a_key() -> None:
    [current] = derived('{ of = "limits.rated_current", unit = 1e-3 }').objects
    assert (current.value, current.why) == (1250, "follows from limits.rated_current")


def test_the_profile_of_an_epos_is_one_motor_throughout() -> None:
    """Numbers of the drive's own that keep those of another motor make every force wrong."""
    epos = drives.load("maxon-epos4", nodes=[5]).nodes[0].profile
    mine = epos.replace(
        limits__rated_torque=0.028, limits__rated_current=1.25, limits__max_current=5.0, motor__torque_constant=0.0224
    )  # fmt: skip
    raw = {one.object.where: one.value for one in mine.objects}
    assert raw == {"0x3001:1": 1250, "0x3001:2": 5000, "0x3001:5": 22400, "0x6076": 28000}


@pytest.mark.parametrize("torque", [29.7e-3, 15.3e-3])
def test_a_small_motor_is_held_in_the_units_of_the_drives_own_object(
    torque: float, tmp_path: Path
) -> None:
    """`limits.rated_torque` of an EPOS4 is written in 1e-6 N m, so 1e-3 N m rounds nothing."""
    text = read_source("maxon-epos4").text
    path = tmp_path / "small.toml"
    small = text.replace("rated_torque = 0.052993", f"rated_torque = {torque}", 1)
    small = small.replace("rated_current = 0.985", f"rated_current = {torque / 0.025:g}", 1)
    path.write_text(small.replace("torque_constant = 0.0538", "torque_constant = 0.025", 1))
    held = {
        one.object.where: one.value for one in drives.load(path, nodes=[1]).nodes[0].profile.objects
    }
    assert held["0x6076"] == round(1e6 * torque)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ('{ of = "limits.current", unit = 1e-3 }', "of = 'limits.current': the profile has no number"),
        ('{ of = "torque.mode", unit = 1e-3 }', "of = 'torque.mode': the profile has no number"),
        ('{ of = "limits.rated_current" }', r"unit = None: must lie in \[1e-9, 1000\]"),
        ('{ of = "limits.rated_current", unit = 0.5 }', "1.25 is 2.5 units of 0.5, more than 1 % off a whole number: "
         "give 1, or the unit"),
        ('{ of = "limits.rated_current", unit = 1e-3, value = 3 }', "value: must be of, unit, type or why"),
        ('{ of = "limits.rated_current", unit = 1e-9, type = "u16" }', "1250000000: must lie in"),
        ('{ of = "limits.rated_current", unit = 1e-3, type = "u17" }', "type = 'u17': must be one of"),
    ],
)  # fmt: skip
def test_a_key_that_gives_no_number_is_refused(line: str, message: str) -> None:
    with pytest.raises(drives.ProfileError, match=rf"mine.toml, line 4: .*{message}"):
        derived(line)


# --- the motor of a device ---


def own_motor(**changes: float) -> ebac.Device:
    """A motor of 25.5 mN m/A and 30 mN m, and an encoder of 500 lines."""
    motor = {"torque_constant": 0.0255, "rated_torque": 0.030, "stall_current": 10.0, **changes}
    device = ebac.Device()
    return device.replace(
        motor=device.motor.replace(**motor), encoder=device.encoder.replace(counts_per_turn=2000)
    )


OWN = {
    "motor.torque_constant": 0.0255,
    "motor.continuous_torque": 0.030,
    "motor.peak_torque": 0.120,
    "motor.counts_per_turn": 2000,
    "limits.rated_torque": 0.030,
    "limits.rated_current": 1.176,
    "limits.max_torque": 0.120,
    "limits.max_current": 4.704,
}


@pytest.mark.parametrize("name", [n for n in drives.builtin() if n != "trinamic-tmcm"])
def test_a_profile_for_a_motor_differs_by_the_keys_of_the_motor(name: str, tmp_path: Path) -> None:
    text = profile_for(name, own_motor(), file="mine.toml")
    assert "RE 30" not in text
    about = text.splitlines()[[one[:5] for one in text.splitlines()].index("about")]
    assert about.endswith(', with the motor of mine.toml"')
    file = tmp_path / "made.toml"
    file.write_text(text, encoding="utf-8")
    nodes = () if "[[node]]" in text else (1,)
    before, after = drives.load(name, nodes=nodes), drives.load(file, nodes=nodes)
    for was, now in zip(before.nodes, after.nodes, strict=True):
        assert now.profile.pdos == was.profile.pdos
        for key, value in now.profile.values.items():
            if key in OWN:
                assert value == pytest.approx(OWN[key], rel=1e-3), key
            else:
                assert value == was.profile.values[key], key


def test_a_drive_that_computes_its_rated_torque_gets_that_of_its_current() -> None:
    made = read_profile(Source(name="mine.toml", text=profile_for("maxon-epos4", own_motor())))
    assert made.values["limits.rated_torque"] == pytest.approx(1.176 * 0.0255)
    raw = {one.object.key: one.value for one in made.objects}
    assert raw[(0x6076, 0)] == 29988


def test_comments_of_a_profile_for_a_motor_are_true() -> None:
    device = own_motor()
    text = profile_for("copley-accelnet", device.replace(drive=ebac.Drive(peak_ratio=2.5)))
    assert "peak_torque = 0.075        # N m, 2.5 times rated\n" in text
    assert "four" not in text
    assert "42.4 N" not in text
    assert "0.0540" not in profile_for("joystick", device)


@pytest.mark.parametrize(
    ("name", "motor", "message"),
    [
        (
            "copley-accelnet",
            {"rated_current": 5.0},
            "torque_constant = 1.176 A, but rated_current = 5 A: should agree within a factor of 2",
        ),
        (
            "joystick",
            {"stall_current": 1.0},
            "torque_constant = 1.176 A, but device.motor.stall_current = 1 A and device.drive.peak_ratio = 4 allow a "
            "peak of 1 A",
        ),
        (
            "trinamic-tmcm",
            {},
            "torque_constant = 1.176 A, but limits.rated_current of trinamic-tmcm = 1 A, the current that this drive "
            "counts its torques in",
        ),
        (
            "copley-accelnet",
            {"rated_torque": 0.0304},
            "limits.rated_torque = 0.0304 N m: the drive holds 30 raw units instead of 30.4",
        ),
        ("copley", {}, "name copley: no such name"),
    ],
)
def test_a_motor_that_contradicts_itself_or_the_drive_is_refused(
    name: str, motor: dict[str, float], message: str
) -> None:
    with pytest.raises(drives.ProfileError) as caught:
        profile_for(name, own_motor(**motor))
    assert message in str(caught.value)


def test_a_drive_that_counts_in_a_current_takes_a_motor_that_is_rated_so() -> None:
    text = profile_for("trinamic-tmcm", own_motor(rated_torque=0.0255))
    made = read_profile(Source(name="mine.toml", text=text))
    assert made.values["limits.rated_torque"] == pytest.approx(0.0255)
    assert made.values["limits.max_current"] == pytest.approx(4.0)

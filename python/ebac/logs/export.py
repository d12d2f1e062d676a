"""Traces in the formats of other programs: Parquet, MATLAB, HDF5."""

from __future__ import annotations

import json
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zlib import crc32

import numpy as np

from ebac._util.progress import Progress
from ebac.scenario_text import text_for_file

if TYPE_CHECKING:
    from ebac.trace import Trace


#: Names of MATLAB are at most this long.
MATLAB_NAME = 63
#: What the checksum of the texts beside numbers is called.
CHECKSUM = "crc32"


def facts(trace: Trace) -> dict[str, str]:
    """Return what stands beside the rows as text: law, parameters, scenario, versions."""
    from ebac.logs.about import versions

    return {
        "law": trace.law,
        "law_repr": trace.law_repr,
        "origin": trace.origin,
        "axes": str(trace.axes),
        "scenario": text_for_file(trace.scenario),
        **({"changed": "true"} if trace.changed else {}),
        **versions(),
    }


def checked(texts: dict[str, str], name: str = "") -> dict[str, str]:
    """Return texts that stand beside numbers, of a column with its name, with their checksum.

    Both formats have checksums of the numbers, and none of their texts.
    """
    code = crc32(json.dumps([name, *sorted(texts.items())]).encode())
    return {**texts, CHECKSUM: f"{code:08x}"}


def to_parquet(trace: Trace, path: Path, progress: Progress) -> None:
    """Write Parquet: a column per axis, `x_0`, `x_1`; unit and meaning in the metadata of each; with checksums."""
    needs("pyarrow", "sweep")
    import pyarrow as pa
    import pyarrow.parquet

    columns = list(trace.flat())
    fields = [
        pa.field(
            name,
            pa.from_numpy_dtype(values.dtype),
            metadata=checked({"unit": info.unit, "meaning": info.meaning}, name),
        )
        for name, info, values in columns
    ]
    schema = pa.schema(fields, metadata=checked(facts(trace)))
    arrays = [pa.array(np.ascontiguousarray(values)) for _, _, values in columns]
    table = pa.Table.from_arrays(arrays, schema=schema)
    pyarrow.parquet.write_table(table, path, write_page_checksum=True)
    progress(len(trace), len(trace))


def to_mat(trace: Trace, path: Path, progress: Progress) -> None:
    """Write a MATLAB file: a matrix (rows, axes) per column, `law_beta` for `law.beta`.

    Beside them stand the structs `units`, `meanings`, `names` (as ebac writes them) and `about`.

    Raises
    ------
    ValueError
        When it has 2 GiB or more, which the format cannot hold.
    """
    needs("scipy", "log")
    from scipy.io import savemat

    names = {name: name.replace(".", "_")[:MATLAB_NAME] for name in trace}
    values: dict[str, Any] = {names[name]: trace[name] for name in trace}
    size = sum(column.nbytes for column in values.values())
    if size >= 1 << 31:
        raise ValueError(
            f"{size / 2**30:.1f} GiB: a .mat file holds less than 2 GiB; export .h5, which MATLAB reads, or a part"
        )
    values["units"] = {names[name]: trace.columns[name].unit for name in trace}
    values["meanings"] = {names[name]: trace.columns[name].meaning for name in trace}
    values["names"] = {short: name for name, short in names.items()}
    values["about"] = facts(trace)
    with path.open("wb") as file:  # a file, because SciPy appends .mat to a name
        savemat(file, values, long_field_names=True, do_compression=True, oned_as="column")
    progress(len(trace), len(trace))


def to_hdf5(trace: Trace, path: Path, progress: Progress) -> None:
    """Write HDF5: a data set per column, attributes `unit` and `meaning`; law, scenario and versions on the file.

    All of it has checksums: each chunk by the filter fletcher32, the structure by the format of HDF5 1.8.
    """
    needs("h5py", "log")
    import h5py

    image = (
        BytesIO()
    )  # on a full disk HDF5 itself would crash later, when what it could not close is collected
    with h5py.File(image, "w", libver=("v108", "v108")) as file:
        file.attrs.update(checked(facts(trace)))
        for i, name in enumerate(trace):
            values = trace[name]
            packed = {
                "compression": "gzip",
                "compression_opts": 1,
                "shuffle": True,
                "fletcher32": True,
            }
            data = file.create_dataset(name, data=values, **(packed if len(values) else {}))
            info = trace.columns[name]
            data.attrs.update(checked({"unit": info.unit, "meaning": info.meaning}, name))
            progress((i + 1) * len(trace) // len(list(trace)), len(trace))
    path.write_bytes(image.getbuffer())


def needs(module: str, extra: str) -> None:
    """Raise ModuleNotFoundError, with the command that installs it, where a library is missing."""
    from importlib.util import find_spec

    if find_spec(module) is None:
        raise ModuleNotFoundError(
            f"this format needs {module}: pip install 'ebac[{extra}]'", name=module
        )

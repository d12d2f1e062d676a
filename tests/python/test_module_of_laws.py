"""A C++ module of laws that is compiled elsewhere."""

import ctypes
import types

import pytest

import ebac._core


def test_a_module_compiled_with_other_headers_is_refused():
    new_capsule = ctypes.pythonapi.PyCapsule_New
    new_capsule.restype = ctypes.py_object
    new_capsule.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]
    nothing = new_capsule(1, None, None)  # who follows this pointer ends the process
    module = types.ModuleType("my_laws")
    with pytest.raises(
        ImportError,
        match=r"my_laws is compiled with headers of ebac 0.0.1 f00d, .*compile the module again",
    ):
        ebac._core._bind_law(module, "Damped", "0.0.1 f00d", nothing)
    assert not hasattr(module, "Damped")

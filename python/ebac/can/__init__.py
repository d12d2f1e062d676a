"""CAN buses inside this process: the python-can interface `ebac` and the nodes on its channels."""

from ebac._util.lazy import from_stub

__getattr__, __dir__, __all__ = from_stub(__name__, __file__)

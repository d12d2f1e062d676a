from ebac._core import *

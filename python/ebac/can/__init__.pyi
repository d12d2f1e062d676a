from ebac.can import channels as channels
from ebac.can import interface as interface

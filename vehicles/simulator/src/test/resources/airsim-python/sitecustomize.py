"""Puts back what newer versions of Python and msgpack removed and the official AirSim client still uses.

Python imports a module of this name at its start, so the client itself stays unmodified.
"""

import collections
import collections.abc
import inspect

for name in collections.abc.__all__:
    if not hasattr(collections, name):
        setattr(collections, name, getattr(collections.abc, name))

if not hasattr(inspect, "getargspec"):
    inspect.getargspec = inspect.getfullargspec

try:
    import msgpack
except ImportError:  # while it is being installed
    pass
else:
    Packer, Unpacker = msgpack.Packer, msgpack.Unpacker

    class EncodingPacker(Packer):
        def __init__(self, *args, encoding=None, **options):
            super().__init__(*args, use_bin_type=False, **options)

    class EncodingUnpacker(Unpacker):
        def __init__(self, *args, encoding=None, **options):
            if encoding is not None:
                options["raw"] = False
            super().__init__(*args, **options)

    msgpack.Packer, msgpack.Unpacker = EncodingPacker, EncodingUnpacker

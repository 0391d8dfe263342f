"""Prints every function that the clients of a package, airsim or cosysairsim, call, with its number of arguments: `name arity`.

The client's methods are called one after another on a connection that only writes down what it is asked for.
"""

import importlib
import inspect
import logging
import sys

logging.disable()


class Called(Exception):
    pass


class Notebook:
    def __init__(self):
        self.functions = {}

    def call(self, function, *arguments):
        self.functions.setdefault(function, set()).add(len(arguments))
        raise Called

    call_async = call


notebook = Notebook()
package = importlib.import_module(sys.argv[1])
kinds = ["MultirotorClient", "CarClient"] + (["ComputerVisionClient"] if package.__name__ == "cosysairsim" else [])
clients = [object.__new__(getattr(package, kind)) for kind in kinds]
for client in clients:
    client.client = notebook
for name, method in (member for client in clients for member in inspect.getmembers(client, inspect.ismethod)):
    wanted = [p for p in inspect.signature(method).parameters.values() if p.default is p.empty]
    arguments = [{"K1": 0.0} if p.name == "distortion_params" else 1 for p in wanted]
    if not name.startswith("_"):
        try:
            method(*arguments)
        except Called:
            pass

for function, arities in sorted(notebook.functions.items()):
    (arity,) = arities
    print(function, arity)

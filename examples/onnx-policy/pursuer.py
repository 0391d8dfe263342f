"""Writes a pursuer as ONNX, as any framework would: a hidden layer of two tanh neurons that turn towards the evader."""

import numpy as np
from onnx import TensorProto, checker, helper, numpy_helper, save

# What it sees: metres ahead and right, m/s ahead and right, cosine and sine of its heading, and three times, s.
scale = np.array([20, 20, 10, 10, 1, 1, 0.2, 0.2, 0.2], np.float32)
hidden = np.zeros((2, 9), np.float32)
hidden[0, 1], hidden[0, 3] = 6, 2  # where it is to the right, and where it goes
hidden[1, 0], hidden[1, 1] = -2, 2  # where it is behind
output = np.array([[1.5], [0.3]], np.float32)

graph = helper.make_graph(
    [
        helper.make_node("Div", ["observation", "scale"], ["scaled"]),
        helper.make_node("Gemm", ["scaled", "hidden"], ["sums"], transB=1),
        helper.make_node("Tanh", ["sums"], ["neurons"]),
        helper.make_node("MatMul", ["neurons", "output"], ["action"]),
    ],
    "pursuer",
    [helper.make_tensor_value_info("observation", TensorProto.FLOAT, ["batch", 9])],
    [helper.make_tensor_value_info("action", TensorProto.FLOAT, ["batch", 1])],
    [
        numpy_helper.from_array(scale, "scale"),
        numpy_helper.from_array(hidden, "hidden"),
        numpy_helper.from_array(output, "output"),
    ],
)
model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)
checker.check_model(model)
save(model, "pursuer.onnx")

"""Teaches a small network of convolutions to find a drone in images, and writes it as ONNX.

python train.py IMAGES OUT.onnx, from the repository's root. IMAGES is a folder with images.npy (count, height, width, 3;
blue, green, red) and truth.npy (count, 5; label: 1 a drone, 0 none, -1 unclear; its box: middle, width and height, pixels).
Where they are missing, Skein draws 12,000 images first.

The model takes images of any size (1, 3, height, width; red, green, blue, 0 to 1) and gives boxes as YOLOv8 does
(1, 5, boxes; middle, width and height in pixels, and a score).
"""

import argparse
import subprocess
import time
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
from onnx import TensorProto, checker, helper, numpy_helper, save

CELL = 8  # pixels between two places that the network answers for
# Of each layer of 3 x 3: channels, stride, dilation.
LAYERS = [(12, 2, 1), (16, 2, 1), (24, 2, 1), (32, 1, 1), (32, 1, 2), (32, 1, 1)]


def initial(seed):
    random = np.random.default_rng(seed)
    weights, before = [], 3
    for channels, _, _ in LAYERS:
        weights.append(
            (random.normal(0, np.sqrt(2 / (9 * before)), (3, 3, before, channels)).astype(np.float32), np.zeros(channels, np.float32))
        )
        before = channels
    head = random.normal(0, 0.01, (1, 1, before, 5)).astype(np.float32)
    # At first nothing is a drone, and boxes are of 10 pixels.
    weights.append((head, np.array([-4, 0, 0, np.log(10 / CELL), np.log(5 / CELL)], np.float32)))
    return weights


def convolved(x, weight, bias, stride=1, dilation=1):
    pad = (weight.shape[0] // 2) * dilation
    y = jax.lax.conv_general_dilated(
        x, weight, (stride, stride), [(pad, pad)] * 2, rhs_dilation=(dilation,) * 2, dimension_numbers=("NHWC", "HWIO", "NHWC")
    )
    return y + bias


def answers(weights, images):
    x = images
    for (weight, bias), (_, stride, dilation) in zip(weights, LAYERS):
        x = jax.nn.relu(convolved(x, weight, bias, stride, dilation))
    return convolved(x, *weights[-1])


def loss(weights, images, heat, counts, cells, wanted, isDrone):
    """CenterNet's (arXiv 1904.07850): the focal loss of the scores, the absolute errors of box and place at the middle."""
    out = answers(weights, images)
    logit = out[..., 0]
    p = jax.nn.sigmoid(logit)
    right = -jax.nn.log_sigmoid(logit) * (1 - p) ** 2 * (heat == 1)
    wrong = -jax.nn.log_sigmoid(-logit) * p**2 * (1 - heat) ** 4 * (heat < 1)
    scores = ((right + wrong) * counts[:, None, None]).sum() / jnp.maximum(isDrone.sum(), 1)
    at = out[jnp.arange(out.shape[0]), cells[:, 1], cells[:, 0], 1:]
    boxes = (jnp.abs(at - wanted).sum(-1) * isDrone).sum() / jnp.maximum(isDrone.sum(), 1)
    return scores + boxes


def targets(truth, height, width):
    """Of each image: the scores wanted at all cells, whether it counts, its drone's cell, and what is wanted there."""
    rows, columns = -(-height // CELL), -(-width // CELL)
    known, box = truth[:, 0], truth[:, 1:]
    isDrone = (known == 1).astype(np.float32)
    # The middle of cell i is that of pixel 8 i.
    at = (box[:, :2] - 0.5) / CELL
    cells = np.clip(np.rint(at), 0, [columns - 1, rows - 1]).astype(np.int32)
    offset = at - cells
    size = np.log(np.maximum(box[:, 2:], 1) / CELL)
    y, x = np.mgrid[:rows, :columns]
    apart = (x - cells[:, 0, None, None]) ** 2 + (y - cells[:, 1, None, None]) ** 2
    spread = np.maximum(0.5, np.sqrt(box[:, 2] * box[:, 3]) / CELL / 4)[:, None, None]
    heat = np.exp(-apart / (2 * spread**2)) * isDrone[:, None, None]
    heat[np.arange(len(truth)), cells[:, 1], cells[:, 0]] = np.where(isDrone == 1, 1, 0)
    # What is hardly seen is neither right nor wrong.
    counts = (known >= 0).astype(np.float32)
    return heat.astype(np.float32), counts, cells, np.concatenate([offset, size], -1).astype(np.float32), isDrone


def batches(images, truth, size, random):
    order = random.permutation(len(images))
    height, width = images.shape[1:3]
    for start in range(0, len(order) - size + 1, size):
        chosen = np.sort(order[start : start + size])
        some = images[chosen][..., ::-1].astype(np.float32) / 255
        told = truth[chosen].copy()
        mirrored = random.random(size) < 0.5
        some[mirrored] = some[mirrored, :, ::-1]
        told[mirrored, 1] = width - told[mirrored, 1]
        some = some * random.uniform(0.8, 1.2, (size, 1, 1, 3)).astype(np.float32)
        some = some + random.normal(0, 1, some.shape).astype(np.float32) * random.uniform(0, 0.02, (size, 1, 1, 1)).astype(np.float32)
        yield np.clip(some, 0, 1), *targets(told, height, width)


@jax.jit
def step(weights, first, second, count, rate, batch):
    """Adam (arXiv 1412.6980)."""
    value, slope = jax.value_and_grad(loss)(weights, *batch)
    tree = jax.tree_util.tree_map
    first = tree(lambda m, g: 0.9 * m + 0.1 * g, first, slope)
    second = tree(lambda v, g: 0.999 * v + 0.001 * g * g, second, slope)
    scale = jnp.sqrt(1 - 0.999**count) / (1 - 0.9**count)
    weights = tree(lambda w, m, v: w - rate * scale * m / (jnp.sqrt(v) + 1e-8), weights, first, second)
    return weights, first, second, value


def train(images, truth, epochs, size, rate, seed):
    random = np.random.default_rng(seed)
    weights = initial(seed)
    first = second = jax.tree_util.tree_map(np.zeros_like, weights)
    total, count = epochs * (len(images) // size), 0
    for epoch in range(epochs):
        started, losses = time.time(), []
        for batch in batches(images, truth, size, random):
            count += 1
            now = rate * min(1, count / 100) * 0.5 * (1 + np.cos(np.pi * count / total))
            weights, first, second, value = step(weights, first, second, count, now, batch)
            losses.append(value)
        print(f"epoch {epoch + 1} of {epochs}: loss {np.mean(losses):.4f}, {time.time() - started:.0f} s", flush=True)
    return [(np.asarray(weight), np.asarray(bias)) for weight, bias in weights]


def exported(weights):
    nodes, constants = [], []

    def constant(name, values, kind=np.float32):
        constants.append(numpy_helper.from_array(np.asarray(values, kind), name))
        return name

    def node(operator, inputs, output, **attributes):
        nodes.append(helper.make_node(operator, inputs, [output], **attributes))
        return output

    def convolution(index, x, stride, dilation):
        weight, bias = weights[index]
        pad = (weight.shape[0] // 2) * dilation
        named = [x, constant(f"w{index}", weight.transpose(3, 2, 0, 1)), constant(f"b{index}", bias)]
        return node("Conv", named, f"c{index}", strides=[stride] * 2, dilations=[dilation] * 2, pads=[pad] * 4)

    x = "image"
    for index, (_, stride, dilation) in enumerate(LAYERS):
        x = node("Relu", [convolution(index, x, stride, dilation)], f"r{index}")
    out = convolution(len(LAYERS), x, 1, 1)
    node("Split", [out, constant("parts", [1, 1, 1, 1, 1], np.int64)], "logit", axis=1)
    nodes[-1].output.extend(["dx", "dy", "logWidth", "logHeight"])
    # A cell's column and row: how many there are until it.
    one = node("Add", [node("Mul", ["logit", constant("zero", 0.0)], "none"), constant("one", 1.0)], "ones")
    cell = constant("cell", float(CELL))
    boxes = []
    for axis, offset, middle in [(3, "dx", "x"), (2, "dy", "y")]:
        until = node("CumSum", [one, constant(f"axis{axis}", axis, np.int64)], f"until{middle}")
        place = node("Sub", [node("Add", [until, offset], f"placed{middle}"), "one"], f"cells{middle}")
        boxes.append(node("Add", [node("Mul", [place, cell], f"pixels{middle}"), constant(f"half{middle}", 0.5)], middle))
    for size in ["Width", "Height"]:
        boxes.append(node("Mul", [node("Exp", [f"log{size}"], f"exp{size}"), cell], size.lower()))
    boxes.append(node("Sigmoid", ["logit"], "score"))
    all = node("Concat", boxes, "all", axis=1)
    node("Reshape", [all, constant("flat", [1, 5, -1], np.int64)], "boxes")
    graph = helper.make_graph(
        nodes,
        "vehicle-detector",
        [helper.make_tensor_value_info("image", TensorProto.FLOAT, [1, 3, "height", "width"])],
        [helper.make_tensor_value_info("boxes", TensorProto.FLOAT, [1, 5, "boxes"])],
        constants,
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)
    checker.check_model(model)
    return model


if __name__ == "__main__":
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("images")
    asked.add_argument("out")
    asked.add_argument("--epochs", type=int, default=11)
    asked.add_argument("--batch", type=int, default=16)
    asked.add_argument("--rate", type=float, default=3e-3)
    asked.add_argument("--seed", type=int, default=1)
    told = asked.parse_args()
    if not Path(told.images, "images.npy").exists():
        folder = Path(told.images).resolve()
        draw = f"recognition/Test/runMain skein.recognition.drawDetectorImages {folder} 12000 1"
        subprocess.run(["./sbtw", draw], check=True)
    images = np.load(f"{told.images}/images.npy", mmap_mode="r")
    truth = np.load(f"{told.images}/truth.npy")
    save(exported(train(images, truth, told.epochs, told.batch, told.rate, told.seed)), told.out)

package skein.onnx

import java.nio.file.Path
import skein.onnx.OnnxGraph.*
import skein.policy.*
import skein.settings.PolicyFile
import skein.signal.SplitMix64

class OnnxPolicySuite extends munit.FunSuite, OnnxFiles:
  private def drawn(name: String): Policy =
    val random = SplitMix64(seed)
    val family = PolicyFamily.parse(name).fold(fail(_), identity)
    val values = Vector.fill(family.space.dimension)((2 * random.nextDouble() - 1).toFloat.toDouble)
    family.policy(values)

  private def graph(nodes: Node*)(constants: (String, Tensor)*): Array[Byte] =
    OnnxFormat.write(OnnxGraph(
      nodes.toVector,
      constants.toMap,
      Vector(Port("x", Float32, Some(Vector(None, Some(9))))),
      Vector(Port("y", Float32, Some(Vector(None, Some(1)))))
    ))

  private def tensor(shape: Int*)(value: Int => Double): Tensor =
    Tensor(shape.toVector, Vector.tabulate(shape.product)(value(_).toFloat.toDouble))

  for name <- Seq("learned:32x32", "learned:6tanhx5:clip", "learned::clip", "learned:7elux4elu", "neural:8x6")
  do
    folder.test(s"$name: a network that was written is read back, to the bit"): folder =>
      val policy = drawn(name)
      val file   = written(folder, OnnxPolicy.write(policy, "evader").fold(fail(_), identity))
      val again  = PolicyFile.read(file).fold(fail(_), identity)
      assertEquals(again.role, Role.Evader)
      assertEquals(PolicyFile.parse(again.role, again.text).map(_.policy), Right(again.policy))
      val random = SplitMix64(seed)
      for _ <- 1 to 50 do
        val what = seen(random, 1)
        // A neural policy does not observe ages.
        def share(policy: Policy) = policy match
          case learned: LearnedPolicy => learned.shares(what.fromOwnHeading)(0)
          case neural: NeuralPolicy   =>
            (neural.heading(what) - what.ownHeadingRad) / (neural.turnRateRadPerS * what.elapsedS)
          case _ => fail(s"$policy is no network")
        if name.startsWith("learned") then assertEquals(share(again.policy), share(policy))
        else assertEqualsDouble(share(again.policy), share(policy), 1e-9)

  folder.test("climbing:6x4tanh: a network that was written is read back, to the bit"): folder =>
    val policy = drawn("climbing:6x4tanh")
    val file   = written(folder, OnnxPolicy.write(policy, "pursuer").fold(fail(_), identity))
    assertEquals(PolicyFile.read(file).map(_.policy), Right(policy))

  /** One network as the frameworks write it: by `Gemm` (PyTorch), by `MatMul` and `Add` (Keras, JAX). */
  private val weights = tensor(3, 9)(i => StrictMath.sin(i))
  private val across  = Tensor(Vector(9, 3), weights.values.grouped(9).toVector.transpose.flatten)
  private val biases  = tensor(3)(i => 0.1 * i)
  private val last    = tensor(1, 3)(i => 0.3 - 0.2 * i)

  private def expected(what: PlanarObservation, hidden: Double => Double, output: Double => Double): Double =
    val sums = weights.values.grouped(9).zip(biases.values).map: (row, bias) =>
      hidden(row.zip(what.fromOwnHeading).map(_ * _).sum + bias)
    output(sums.zip(last.values).map(_ * _).sum)

  for
    (what, bytes, hidden, output) <- Seq[(String, Array[Byte], Double => Double, Double => Double)](
      (
        "Gemm, Relu, Gemm, Tanh",
        graph(
          Node("Flatten", Vector("x"), Vector("f")),
          Node("Gemm", Vector("f", "w", "b"), Vector("g"), Map("transB" -> Attribute.Whole(1))),
          Node("Relu", Vector("g"), Vector("r")),
          Node("Gemm", Vector("r", "v"), Vector("s"), Map("transB" -> Attribute.Whole(1))),
          Node("Tanh", Vector("s"), Vector("y"))
        )("w" -> weights, "b" -> biases, "v" -> last),
        _.max(0),
        math.tanh
      ),
      (
        "Gemm, Elu as skrl and rsl_rl have it, Gemm, Tanh",
        graph(
          Node("Gemm", Vector("x", "w", "b"), Vector("g"), Map("transB" -> Attribute.Whole(1))),
          Node("Elu", Vector("g"), Vector("r")),
          Node("Gemm", Vector("r", "v"), Vector("s"), Map("transB" -> Attribute.Whole(1))),
          Node("Tanh", Vector("s"), Vector("y"))
        )("w" -> weights, "b" -> biases, "v" -> last),
        sum => if sum > 0 then sum else math.exp(sum) - 1,
        math.tanh
      ),
      (
        "MatMul and Add, Tanh, no activation of the output",
        graph(
          Node("MatMul", Vector("x", "w"), Vector("m")),
          Node("Add", Vector("b", "m"), Vector("a")),
          Node("Tanh", Vector("a"), Vector("t")),
          Node("Transpose", Vector("v"), Vector("vt")),
          Node("MatMul", Vector("t", "vt"), Vector("o")),
          Node("Identity", Vector("o"), Vector("y"))
        )("w" -> across, "b" -> biases, "v" -> last),
        math.tanh,
        _.max(-1).min(1)
      ),
      (
        "Sigmoid, and an output clipped and scaled",
        graph(
          Node("Gemm", Vector("x", "w", "b"), Vector("g")),
          Node("Sigmoid", Vector("g"), Vector("s")),
          Node("Gemm", Vector("s", "v"), Vector("o"), Map("transB" -> Attribute.Whole(1))),
          Node("Clip", Vector("o", "least", "most"), Vector("c")),
          Node("Mul", Vector("c", "scale"), Vector("y"))
        )(
          "w"     -> across,
          "b"     -> biases,
          "v"     -> last,
          "least" -> tensor()(_ => -0.25),
          "most"  -> tensor()(_ => 0.5),
          "scale" -> tensor(1)(_ => 2)
        ),
        sum => 1 / (1 + math.exp(-sum)),
        sum => 2 * sum.max(-0.25).min(0.5)
      )
    )
  do
    folder.test(s"$what: becomes a Skein network with equal answers"): folder =>
      val file = PolicyFile.read(written(folder, bytes)).fold(fail(_), identity)
      assertEquals(file.role, Role.Pursuer)
      val policy = file.policy.asInstanceOf[LearnedPolicy]
      val random = SplitMix64(seed)
      for _ <- 1 to 50 do
        val one = seen(random, 1)
        assertEqualsDouble(policy.shares(one.fromOwnHeading)(0), expected(one, hidden, output), 1e-9)

  folder.test("its role can be stated, and an evader turns by up to half a turn"): folder =>
    val file = written(
      folder,
      graph(Node("MatMul", Vector("x", "w"), Vector("y")))("w" -> tensor(9, 1)(i => 0.01 * i))
    )
    val evader = PolicyFile.read(s"evader:$file").fold(fail(_), identity)
    assertEquals((evader.role, evader.parameters.takeRight(2)), (Role.Evader, Vector(0.0, math.Pi)))
    assertEquals(PolicyFile.chosen(Role.Evader, file).map(_.text), Right(evader.text))
    assert(PolicyFile.chosen(Role.Evader, s"pursuer:$file").left.exists(_.contains("for the other role")))

  private def refused(folder: Path, bytes: Array[Byte]): String =
    PolicyFile.read(written(folder, bytes)).fold(identity, file => fail(s"got ${file.label}"))

  folder.test("a wrong shape is reported with both shapes"): folder =>
    val wrong = OnnxFormat.write(OnnxGraph(
      Vector(Node("MatMul", Vector("obs", "w"), Vector("act"))),
      Map("w" -> tensor(12, 2)(_ => 1)),
      Vector(Port("obs", Float32, Some(Vector(None, Some(12))))),
      Vector(Port("act", Float32, Some(Vector(Some(1), Some(2)))))
    ))
    assert(
      refused(folder, wrong).endsWith(
        "expected one input of shape (batch, 9) and one output of shape (batch, 1), " +
          "or (batch, 13) and (batch, 2) if it climbs, got input 'obs' of (any, 12) and output 'act' of (1, 2)"
      ),
      refused(folder, wrong)
    )
    val narrow =
      graph(Node("MatMul", Vector("x", "w"), Vector("y")))("w" -> tensor(12, 1)(_ => 1))
    assert(refused(folder, narrow).contains("expected weights of 9 inputs, got 12"), refused(folder, narrow))

  folder.test("weights that are not finite, and other models without a runtime, are reported"): folder =>
    val infinite = graph(Node("MatMul", Vector("x", "w"), Vector("y")))(
      "w" -> tensor(9, 1)(i => if i == 4 then Double.NaN else 1)
    )
    assert(refused(folder, infinite).contains("expected finite weights"))
    val other = graph(
      Node("MatMul", Vector("x", "w"), Vector("m")),
      Node("Sin", Vector("m"), Vector("y"))
    )("w" -> tensor(9, 1)(_ => 1))
    val reason = refused(folder, other)
    assert(reason.contains("operator Sin is none of Identity"), reason)
    assert(reason.contains("nothing here runs other models"), reason)

  folder.test("a damaged file is reported, wherever it is damaged"): folder =>
    val whole = OnnxPolicy.write(drawn("learned:3"), "pursuer").fold(fail(_), identity)
    for length <- 0 until whole.length by 7 do
      val cut = PolicyFile.read(written(folder, whole.take(length)))
      // A message cut at its end is a shorter message: without notes it is still a model.
      assert(cut.isRight || cut.left.exists(_.startsWith(folder.toString)), s"cut at $length: $cut")
    val random = SplitMix64(seed)
    for _ <- 1 to 300 do
      val bytes = whole.clone()
      bytes(random.nextInt(bytes.length)) = random.nextInt(256).toByte
      PolicyFile.read(written(folder, bytes)): Unit
    assert(refused(folder, Array.emptyByteArray).contains("expected an ONNX model: it has no graph"))
    assert(refused(folder, "no model".getBytes).contains("expected an ONNX model: it is damaged"))
    assert(PolicyFile.read("nowhere.onnx").left.exists(_.contains("there is no such file")))

  test("a policy that is not a network cannot be written as ONNX"):
    assert(OnnxPolicy.write(PaperPursuer(1), "pursuer").left.exists(_.contains("only networks")))

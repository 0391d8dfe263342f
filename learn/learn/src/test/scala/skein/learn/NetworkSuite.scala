package skein.learn

import skein.signal.SplitMix64

class NetworkSuite extends munit.FunSuite:

  /** The network's output in doubles, by its definition. */
  private def byHand(network: Network, input: Seq[Double]): Vector[Double] =
    (0 until network.layers).foldLeft(input.toVector): (seen, layer) =>
      val outs = network.widths(layer + 1)
      Vector.tabulate(outs): neuron =>
        val sum = network.parameters(network.biasesAt(layer) + neuron) + seen.indices
          .map(i => seen(i) * network.parameters(network.weightsAt(layer) + i * outs + neuron))
          .sum
        if layer < network.layers - 1 then sum.max(0.0) else sum

  private def inputs(random: SplitMix64, count: Int) =
    Array.fill(count)((2 * random.nextDouble() - 1).toFloat)

  for widths <- Seq(Vector(3, 2), Vector(5, 7, 3, 2), Vector(9, 64, 70, 1), Vector(2, 130, 5)) do
    test(s"$widths: outputs equal those of the definition, in every row"):
      val random  = SplitMix64(4)
      val network = Network(widths).draw(random)
      val pass    = Pass(widths, 5)
      val rows    = inputs(random, 5 * widths.head)
      System.arraycopy(rows, 0, pass.input, 0, rows.length)
      pass.forward(network, 0, 2)
      pass.forward(network, 2, 5)
      for row <- 0 until 5 do
        val expected =
          byHand(network, rows.slice(row * widths.head, (row + 1) * widths.head).map(_.toDouble).toSeq)
        for (value, output) <- expected.zipWithIndex do
          assertEqualsDouble(pass.output(row * widths.last + output).toDouble, value, 1e-5, s"row $row")

    test(s"$widths: gradients by parameters and inputs equal finite differences"):
      val random   = SplitMix64(7)
      val network  = Network(widths).draw(random)
      val pass     = Pass(widths, 3)
      val rows     = inputs(random, 3 * widths.head)
      val weighted = inputs(random, 3 * widths.last)
      // A weighted sum of all outputs, in doubles.
      def value(): Double =
        (0 until 3).map: row =>
          val seen = rows.slice(row * widths.head, (row + 1) * widths.head).map(_.toDouble).toSeq
          byHand(network, seen).zipWithIndex.map((y, output) => y * weighted(row * widths.last + output)).sum
        .sum
      def slope(array: Array[Float], at: Int): Double =
        val kept = array(at)
        val step = 1.0f / 1024
        array(at) = kept + step
        val above = value()
        array(at) = kept - step
        val below = value()
        array(at) = kept
        (above - below) / (2 * step)
      System.arraycopy(rows, 0, pass.input, 0, rows.length)
      System.arraycopy(weighted, 0, pass.outputError, 0, weighted.length)
      val gradient = Array.ofDim[Float](network.parameters.length)
      pass.forward(network, 0, 3)
      pass.backward(network, 0, 2, gradient)
      pass.backward(network, 2, 3, gradient)
      pass.backwardToInput(network, 0, 3)
      val every = (network.parameters.length / 300).max(1)
      for at <- network.parameters.indices by every do
        assertEqualsDouble(gradient(at).toDouble, slope(network.parameters, at), 2e-3, s"parameter $at")
      for at <- rows.indices do
        assertEqualsDouble(pass.inputError(at).toDouble, slope(rows, at), 2e-3, s"input $at")

  test("rows have equal bits whether they are computed together or one by one"):
    val random  = SplitMix64(1)
    val network = Network(Vector(9, 64, 64, 2)).draw(random)
    val pass    = Pass(network.widths, 33)
    val rows    = inputs(random, 33 * 9)
    System.arraycopy(rows, 0, pass.input, 0, rows.length)
    pass.forward(network, 0, 33)
    val together = pass.output.clone
    for row <- 0 until 33 do pass.forward(network, row, row + 1)
    assertEquals(pass.output.toVector, together.toVector)

  test("an ignored input changes nothing until it is learned"):
    val network = Network(Vector(2, 4, 1)).draw(SplitMix64(3))
    network.ignore(1)
    assertEquals(byHand(network, Seq(0.3, 5)), byHand(network, Seq(0.3, -7)))

  test("Adam's first steps are those of its definition"):
    // g = 1, then −2: m = 0.1, −0.11; v = 0.001, 0.004999; corrected by 1 − β^t.
    val adam       = Adam(1, rate = 0.1)
    val parameters = Array(1f)
    adam.step(parameters, Array(1f))
    assertEqualsDouble(parameters(0).toDouble, 0.9, 1e-6)
    adam.step(parameters, Array(-2f))
    val expected = 0.9 - 0.1 * (-0.11 / (1 - 0.81)) / math.sqrt(0.004999 / (1 - 0.998001))
    assertEqualsDouble(parameters(0).toDouble, expected, 1e-6)

  test("a shape without inputs or with a layer of no neurons is refused"):
    for widths <- Seq(Vector(3), Vector(3, 0, 1), Vector(0, 1), Vector(1, 100_000)) do
      intercept[IllegalArgumentException](Network(widths)): Unit

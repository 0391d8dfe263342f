package skein.fusion

import skein.signal.SplitMix64
import skein.units.*

class FusionSuite extends munit.FunSuite:
  private def at(ms: Double): Instant = Instant.Epoch + Span.ofMillis(ms)

  private def normals(random: SplitMix64)(sd: Double) = Vector3(
    sd * skein.signal.NormalQuantile(random.nextDouble().max(1e-9)),
    sd * skein.signal.NormalQuantile(random.nextDouble().max(1e-9)),
    sd * skein.signal.NormalQuantile(random.nextDouble().max(1e-9))
  )

  /** Readings and detections of a vehicle on a curve, each with its own valid time. */
  private def measured(count: Int, seed: Long): Vector[Measurement] =
    val random = SplitMix64(seed)
    val noise  = normals(random)
    Vector.tabulate(count): i =>
      val ms          = 20.0 * i + 10 * random.nextDouble()
      val positionNed = Vector3(0.008 * ms, 5 * math.sin(ms / 1000), -20) + noise(0.1)
      if i % 3 == 0 then
        Measurement(
          at(ms),
          positionNed,
          Matrix3.diagonal(0.01),
          Option.when(i % 2 == 0)((
            ned = Vector3(8, 5 * math.cos(ms / 1000), 0) + noise(0.3),
            covariance = Matrix3.diagonal(0.09)
          ))
        )
      else
        PolarMeasurement
          .of(positionNed, (azimuth = Radians(0.02), elevation = Radians(0.03), range = Metres(0.5)))
          .seenFrom(at(ms), noise(0.2), Quaternion.Identity)

  private def joined(measurements: Seq[Measurement], settings: FusionSettings = FusionSettings()): Fusion =
    measurements.foldLeft(Fusion(settings))((fusion, one) =>
      fusion.including(one).getOrElse(fail(s"too old: $one"))
    )

  test("measurements in any order give the estimate of the sorted measurements, to the last bit"):
    for seed <- 1L to 20L do
      val inOrder = measured(40, seed)
      val random  = SplitMix64(seed)
      val mixed   = inOrder.sortBy(_ => random.nextLong())
      assertEquals(joined(mixed).belief, joined(inOrder).belief, s"seed $seed")

  test("the estimate is the least-squares solution for all measurements together"):
    for seed <- 1L to 5L do
      val all      = measured(12, seed)
      val belief   = joined(all).belief.get
      val (x, cov) = BatchOracle.last(all, FusionSettings())
      val mean     = Vector(belief.positionNed, belief.velocityNed).flatMap(v => Vector(v.x, v.y, v.z))
      for i <- 0 until 6 do assertEqualsDouble(mean(i), x(i), 1e-6, s"seed $seed, component $i")
      val blocks = Vector(
        (belief.position, 0, 0),
        (belief.cross, 0, 3),
        (belief.velocity, 3, 3)
      )
      for (block, row, column) <- blocks; j <- 0 until 3 do
        val came = block.column(j)
        for (value, i) <- Vector(came.x, came.y, came.z).zipWithIndex do
          assertEqualsDouble(value, cov(row + i)(column + j), 1e-6, s"seed $seed, ($i, $j)")

  test("a measurement older than the history is refused; one at its limit is added"):
    val settings            = FusionSettings(history = Span.ofMillis(100))
    def reading(ms: Double) = Measurement(at(ms), Vector3.Zero, Matrix3.diagonal(1))
    val fusion              = joined(Vector(0, 50, 120, 200).map(ms => reading(ms)), settings)
    assertEquals(fusion.including(reading(99)), None)
    assertEquals(fusion.including(reading(40)), None)
    assert(fusion.including(reading(100)).isDefined)

  test("forgotten measurements still count: a short history gives the estimate of a long one"):
    val all   = measured(200, 3)
    val few   = FusionSettings(mostMeasurements = 4)
    val brief = FusionSettings(history = Span.ofMillis(50))
    for settings <- List(few, brief) do assertEquals(joined(all, settings).belief, joined(all).belief)

  test("with a limited number of measurements, one older than all stored ones is refused"):
    val fusion = joined(measured(50, 1), FusionSettings(mostMeasurements = 4))
    assertEquals(fusion.including(Measurement(at(20 * 44), Vector3.Zero, Matrix3.diagonal(1))), None)

  test("a predicted estimate moves with its velocity and becomes less certain"):
    val fusion = joined(measured(30, 2))
    val now    = fusion.belief.get
    val later  = fusion.at(now.at + Span.ofMillis(500)).get
    assertEqualsDouble((later.positionNed - now.positionNed - now.velocityNed * 0.5).norm, 0, 1e-12)
    assert(later.position.xx > now.position.xx)
    assertEquals(fusion.at(now.at - Span.ofMillis(1)), None)

/** The model's normal equations over the states of all moments simultaneously, solved densely. */
private object BatchOracle:

  def last(all: Vector[Measurement], settings: FusionSettings): (Vector[Double], Vector[Vector[Double]]) =
    val size        = 6 * all.size
    val information = Array.ofDim[Double](size, size)
    val vector      = new Array[Double](size)

    /** Adds one observation: coefficients by index, observed values, and inverse covariance. */
    def observe(rows: Vector[Map[Int, Double]], came: Vector[Double], weight: Vector[Vector[Double]]): Unit =
      for
        (a, i) <- rows.zipWithIndex; (b, j) <- rows.zipWithIndex
        (m, x) <- a
      do
        vector(m) += x * weight(i)(j) * came(j)
        for (n, y) <- b do information(m)(n) += x * weight(i)(j) * y

    def rowsOf(m: Matrix3) =
      inverse(Vector(Vector(m.xx, m.xy, m.xz), Vector(m.yx, m.yy, m.yz), Vector(m.zx, m.zy, m.zz)))
    def values(v: Vector3) = Vector(v.x, v.y, v.z)
    def pick(start: Int)   = Vector.tabulate(3)(i => Map(start + i -> 1.0))

    for (one, k) <- all.zipWithIndex do
      observe(pick(6 * k), values(one.positionNed), rowsOf(one.covariance))
      one.velocity.foreach(v => observe(pick(6 * k + 3), values(v.ned), rowsOf(v.covariance)))
      if k == 0 && one.velocity.isEmpty then
        observe(
          pick(3),
          Vector(0, 0, 0),
          rowsOf(Matrix3.diagonal(settings.topSpeed.value * settings.topSpeed.value))
        )
      if k > 0 then
        val dt = one.validAt.since(all(k - 1).validAt).toSeconds
        for axis <- 0 until 3 do
          val (p, v, p1, v1) = (6 * (k - 1) + axis, 6 * (k - 1) + 3 + axis, 6 * k + axis, 6 * k + 3 + axis)
          val q              = settings.acceleration
          val noise = Vector(Vector(q * dt * dt * dt / 3, q * dt * dt / 2), Vector(q * dt * dt / 2, q * dt))
          observe(
            Vector(Map(p1 -> 1.0, p -> -1.0, v -> -dt), Map(v1 -> 1.0, v -> -1.0)),
            Vector(0, 0),
            inverse(noise)
          )

    val covariance = inverse(information.toVector.map(_.toVector))
    val mean       = covariance.map(row => row.indices.map(j => row(j) * vector(j)).sum)
    (mean.takeRight(6), covariance.takeRight(6).map(_.takeRight(6)))

  private def inverse(matrix: Vector[Vector[Double]]): Vector[Vector[Double]] =
    val n    = matrix.size
    val rows =
      Array.tabulate(n)(i => (matrix(i) ++ Vector.tabulate(n)(j => if i == j then 1.0 else 0.0)).toArray)
    for c <- 0 until n do
      val pivot = (c until n).maxBy(i => math.abs(rows(i)(c)))
      val held  = rows(c)
      rows(c) = rows(pivot)
      rows(pivot) = held
      val by = rows(c)(c)
      for j <- 0 until 2 * n do rows(c)(j) /= by
      for i <- 0 until n if i != c && rows(i)(c) != 0 do
        val times = rows(i)(c)
        for j <- 0 until 2 * n do rows(i)(j) -= times * rows(c)(j)
    rows.toVector.map(_.drop(n).toVector)

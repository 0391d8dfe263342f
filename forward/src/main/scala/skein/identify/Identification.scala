package skein.identify

import skein.units.Decimals.fixed
import skein.vehicle.{ReducedFlight, ReducedModel}

/** A fitted parameter. The interval covers the truth with 95 % probability.
  *
  * @param atBound
  *   the fit stopped at a bound of the parameter: neither value nor interval mean much
  */
final case class Fitted(name: String, value: Double, least: Double, most: Double, atBound: Boolean)

/** A model fitted to flights.
  *
  * @param predictions
  *   samples that were predicted, each from some earlier one
  * @param velocityRmsMps
  *   of one component's error over all predictions
  * @param positionRmsM
  *   the same
  */
final case class Identification(
    structure: Structure,
    parameters: Vector[Fitted],
    model: ReducedModel,
    predictions: Int,
    blocks: Int,
    velocityRmsMps: Double,
    positionRmsM: Double
)

/** Fits a [[skein.vehicle.ReducedModel]] to flights. From a sample every [[Identification.StartEveryS]] all samples within
  * the horizon are predicted; the parameters minimise the sum of squared errors of velocity (m/s) and position (m).
  *
  * Errors of one stretch of flight hang together, so that the intervals come from the Jacobian with the sandwich
  * estimator over blocks of [[Identification.BlockS]] of one vehicle (Liang, Zeger, Biometrika 73 (1986)): the first-order
  * form of a bootstrap over such blocks. They cover chance; not a bias of the arrivals' times, which goes into the dead
  * time one to one.
  */
object Identification:
  val StartEveryS     = 0.5
  val BlockS          = 5.0
  val DefaultHorizonS = 2.0

  /** @return
    *   or what is lacking
    */
  def of(
      flights: Vector[Flown],
      structure: Structure,
      horizonS: Double = DefaultHorizonS
  ): Either[String, Identification] =
    val windows =
      for
        (flown, number) <- flights.zipWithIndex
        from            <- flown.starts(StartEveryS, horizonS)
      yield Window(flown, from, horizonS, (number, (flown.samples(from).atS / BlockS).floor.toLong))
    val blocks = windows.map(_.block).distinct
    if blocks.sizeIs < 2 * structure.parameters.size then
      Left(
        s"expected at least ${(2 * structure.parameters.size * BlockS).fixed(0)} s of flight to identify ${structure.label}, " +
          s"came ${flights.map(spanS).sum.fixed(0)} s"
      )
    else if !flights.exists(_.arrivals.distinctBy(command => (command.vx, command.vy)).sizeIs > 1) then
      Left("expected flights with changing commands, came none")
    else Right(fit(windows, blocks.size, structure))

  private def spanS(flown: Flown): Double =
    if flown.samples.isEmpty then 0 else flown.samples.last.atS - flown.samples.head.atS

  /** @param block
    *   flight and stretch: errors within one hang together
    */
  private final case class Window(flown: Flown, from: Int, horizonS: Double, block: (Int, Long)):
    val size: Int =
      val until = flown.samples(from).atS + horizonS + Flown.Rounding
      flown.samples.indexWhere(_.atS > until, from) match
        case -1    => flown.samples.size - from - 1
        case index => index - from - 1

  /** Per predicted sample: errors of vx, vy, x, y. */
  private val PerSample = 4

  private def fit(windows: Vector[Window], blocks: Int, structure: Structure): Identification =
    val samples                                         = windows.map(_.size).sum
    def residuals(values: Array[Double]): Array[Double] =
      val model  = structure.model(values)
      val flight = ReducedFlight(model)
      val errors = Array.ofDim[Double](PerSample * samples)
      var at     = 0
      for window <- windows do
        window.flown.predict(flight, model.deadTimeS, window.from, window.horizonS): sample =>
          val seen = window.flown.samples(sample)
          errors(at) = flight.vx - seen.vx; errors(at + 1) = flight.vy - seen.vy
          errors(at + 2) = flight.x - seen.x; errors(at + 3) = flight.y - seen.y
          at += PerSample
      errors

    val solution  = LeastSquares.solve(structure.start, structure.least, structure.most)(residuals)
    val deviation = standardErrors(solution, windows, blocks)
    val quantile  = studentQuantile(blocks - 1)
    val fitted    = structure.parameters.indices.toVector.map: i =>
      val value         = solution.parameters(i)
      val (least, most) = Structure.bounds(structure.parameters(i))
      Fitted(
        structure.parameters(i),
        value,
        value - quantile * deviation(i),
        value + quantile * deviation(i),
        value <= least || value >= most
      )
    val squares                  = solution.residuals.map(error => error * error)
    def rms(offset: Int): Double =
      math.sqrt((0 until samples).map(k =>
        squares(k * PerSample + offset) + squares(k * PerSample + offset + 1)
      ).sum / (2 * samples))
    Identification(structure, fitted, structure.model(solution.parameters), samples, blocks, rms(0), rms(2))

  /** The sandwich (JᵀJ)⁻¹ (Σ gᵦgᵦᵀ) (JᵀJ)⁻¹ with gᵦ = Jᵦᵀrᵦ summed over a block. */
  private def standardErrors(
      solution: LeastSquares.Solution,
      windows: Vector[Window],
      blocks: Int
  ): Array[Double] =
    val n       = solution.parameters.length
    val normal  = Array.tabulate(n, n)((i, j) => LeastSquares.dot(solution.jacobian(i), solution.jacobian(j)))
    val inverse = LinearSystem.inverseColumns(normal).getOrElse(Array.fill(n, n)(Double.NaN))
    val starts  = windows.scanLeft(0)((at, window) => at + PerSample * window.size)
    val scores  = windows.indices.groupMap(windows(_).block)(identity).values.map: members =>
      Array.tabulate(n): i =>
        members.iterator
          .flatMap(member => Iterator.range(starts(member), starts(member + 1)))
          .map(k => solution.jacobian(i)(k) * solution.residuals(k))
          .sum
    val spreads = scores.map: score =>
      inverse.map(row => LeastSquares.dot(row, score))
    Array.tabulate(n)(i => math.sqrt(spreads.map(s => s(i) * s(i)).sum * blocks / (blocks - 1)))

  /** 97.5 % quantile of Student's distribution, by the first term of its expansion about the normal one. */
  private def studentQuantile(degrees: Int): Double =
    val z = 1.959964
    z + (z * z * z + z) / (4 * degrees)

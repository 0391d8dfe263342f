package skein.identify

import skein.forecast.Structure
import skein.signal.StudentQuantile
import skein.units.Decimals.{brief, fixed}
import skein.vehicle.{ObservedPlant, PlantFlight}

/** A fitted parameter with its 95 % confidence interval from `least` to `most`.
  *
  * @param atBound whether the fit stopped at a bound of the parameter; then value and interval are unreliable
  */
final case class Fitted(name: String, value: Double, least: Double, most: Double, atBound: Boolean)

/** A plant fitted to flights.
  *
  * @param predictions number of predicted samples, each predicted from an earlier one
  * @param velocityRmsMps root mean square error of one velocity component over all predictions
  * @param positionRmsM root mean square error of one position component
  * @param isConverged if false, the fit was still improving when it stopped
  */
final case class Identification(
    structure: Structure,
    parameters: Vector[Fitted],
    plant: ObservedPlant[?],
    predictions: Int,
    blocks: Int,
    velocityRmsMps: Double,
    positionRmsM: Double,
    isConverged: Boolean
)

/** Fits the plants of a [[skein.forecast.Structure]] to flights. From a sample every
  * [[Identification.StartEveryS]], all samples within the horizon are predicted; the parameters minimise the
  * sum of squared errors of velocity (m/s) and position (m). If a sample lacks a part of the plant's state,
  * that part is simulated from the earlier samples.
  *
  * Errors within one stretch of flight are correlated. Therefore the intervals come from the Jacobian with
  * the sandwich estimator over blocks of [[Identification.blockS]] of one vehicle (Liang, Zeger, Biometrika
  * 73 (1986)), which is the first-order form of a bootstrap over such blocks. They cover random errors, but
  * no bias of the arrival times, which adds to the dead time in full.
  */
object Identification:
  val StartEveryS     = 0.5
  val DefaultHorizonS = 2.0

  /** Length of a block, s: 5, or two and a half horizons. Errors of windows less than a horizon apart are
    * those of common samples, so shorter blocks would make intervals too narrow: with blocks of one horizon
    * by a fifth.
    */
  def blockS(horizonS: Double): Double = (2.5 * horizonS).max(5)

  /** Fits a structure. Left says what the flights lack. */
  def of(
      flights: Vector[TimeHistory],
      structure: Structure,
      horizonS: Double = DefaultHorizonS
  ): Either[String, Identification] =
    val windows =
      for
        (flown, number) <- flights.zipWithIndex
        from            <- flown.starts(StartEveryS, horizonS)
      yield Window(flown, from, horizonS, (number, (flown.samples(from).atS / blockS(horizonS)).floor.toLong))
    val blocks = windows.map(_.block).distinct
    if blocks.sizeIs < 2 * structure.space.dimension then
      val usableS = flights.map(flown => (flown.spanS - horizonS).max(0)).sum
      Left(
        s"expected at least ${(2 * structure.space.dimension * blockS(horizonS)).fixed(0)} s of flight to identify ${structure.label}, " +
          s"without the last ${horizonS.brief} s of each stretch, from which no whole horizon can be predicted; " +
          s"got ${usableS.fixed(0)} s"
      )
    else if !flights.exists(_.arrivals.distinctBy(command => (command.vx, command.vy)).sizeIs > 1) then
      Left("expected flights with changing commands, got none")
    else fit(flights, windows, blocks.size, structure)

  /** A stretch of flight within which samples are predicted.
    *
    * @param block flight and stretch; errors within one block are correlated
    */
  private final case class Window(flown: TimeHistory, from: Int, horizonS: Double, block: (Int, Long)):
    val size: Int =
      val until = flown.samples(from).atS + horizonS + TimeHistory.Rounding
      flown.samples.indexWhere(_.atS > until, from) match
        case -1    => flown.samples.size - from - 1
        case index => index - from - 1

  /** Number of errors per predicted sample: vx, vy, x, y. */
  private val PerSample = 4

  private def residuals[S](
      plant: ObservedPlant[S],
      flights: Vector[TimeHistory],
      windows: Vector[Window],
      samples: Int
  ): Array[Double] =
    val flight = PlantFlight(plant)
    val states = flights.map(_.states(plant))
    val errors = Array.ofDim[Double](PerSample * samples)
    var at     = 0
    for window <- windows do
      window.flown.predict(flight, states(window.block._1)(window.from), window.from, window.horizonS):
        sample =>
          val seen      = window.flown.samples(sample)
          val predicted = flight.reading
          errors(at) = predicted.northMps - seen.vx; errors(at + 1) = predicted.eastMps - seen.vy
          errors(at + 2) = predicted.northM - seen.x; errors(at + 3) = predicted.eastM - seen.y
          at += PerSample
    errors

  private def fit(
      flights: Vector[TimeHistory],
      windows: Vector[Window],
      blocks: Int,
      structure: Structure
  ): Either[String, Identification] =
    val axes     = structure.space.axes
    val samples  = windows.map(_.size).sum
    val solution = LeastSquares.solve(
      axes.map(_.default).toArray,
      axes.map(_.least).toArray,
      axes.map(_.most).toArray
    )(values => residuals(structure.plant(values.toVector), flights, windows, samples))
    standardErrors(solution, windows, blocks)
      .toRight(s"the flights do not tell the parameters of ${structure.label} apart")
      .map(fitted(structure, solution, _, blocks, samples))

  /** A value within this share of the range from a bound counts as at the bound, because a fit whose best
    * value is the bound stops close to it.
    */
  private val AtBound = 1e-6

  private def fitted(
      structure: Structure,
      solution: LeastSquares.Solution,
      deviation: Array[Double],
      blocks: Int,
      samples: Int
  ): Identification =
    val quantile = StudentQuantile.twoSided95(blocks - 1)
    val fitted   = structure.space.axes.zipWithIndex.map: (axis, i) =>
      val value = solution.parameters(i)
      Fitted(
        axis.name,
        value,
        value - quantile * deviation(i),
        value + quantile * deviation(i),
        axis.margin(value) <= AtBound
      )
    val squares                  = solution.residuals.map(error => error * error)
    def rms(offset: Int): Double =
      math.sqrt((0 until samples).map(k =>
        squares(k * PerSample + offset) + squares(k * PerSample + offset + 1)
      ).sum / (2 * samples))
    val plant = structure.plant(solution.parameters.toVector)
    Identification(structure, fitted, plant, samples, blocks, rms(0), rms(2), solution.isConverged)

  /** The sandwich (JᵀJ)⁻¹ (Σ gᵦgᵦᵀ) (JᵀJ)⁻¹, where gᵦ = Jᵦᵀrᵦ is summed over a block.
    *
    * @return None if JᵀJ is singular
    */
  private def standardErrors(
      solution: LeastSquares.Solution,
      windows: Vector[Window],
      blocks: Int
  ): Option[Array[Double]] =
    val n      = solution.parameters.length
    val normal = Array.tabulate(n, n)((i, j) => LeastSquares.dot(solution.jacobian(i), solution.jacobian(j)))
    val starts = windows.scanLeft(0)((at, window) => at + PerSample * window.size)
    val scores = windows.indices.groupMap(windows(_).block)(identity).values.map: members =>
      Array.tabulate(n): i =>
        members.iterator
          .flatMap(member => Iterator.range(starts(member), starts(member + 1)))
          .map(k => solution.jacobian(i)(k) * solution.residuals(k))
          .sum
    LinearSystem.inverseColumns(normal).map: inverse =>
      val spreads = scores.map: score =>
        inverse.map(row => LeastSquares.dot(row, score))
      Array.tabulate(n)(i => math.sqrt(spreads.map(s => s(i) * s(i)).sum * blocks / (blocks - 1)))

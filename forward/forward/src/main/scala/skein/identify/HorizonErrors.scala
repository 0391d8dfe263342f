package skein.identify

import skein.policy.ActionGuidance
import skein.units.Vector3
import skein.vehicle.*

/** Errors of predictions over one horizon.
  *
  * @param horizonS duration of the predictions, s
  * @param predictions number of predictions that were compared
  * @param positionP50M median distance from the actual position, m
  * @param positionP95M 95th percentile of that distance, m
  * @param velocityP50Mps median difference from the actual velocity, m/s
  * @param velocityP95Mps 95th percentile of that difference, m/s
  */
final case class HorizonError(
    horizonS: Double,
    predictions: Int,
    positionP50M: Double,
    positionP95M: Double,
    velocityP50Mps: Double,
    velocityP95Mps: Double
)

/** Measures a fitted model's predictions over several horizons. */
object HorizonErrors:
  val HorizonsS: Vector[Double] = Vector(1, 2, 5)

  /** The errors of a model's predictions. A prediction starts from a sample every half second, and is
    * compared with the sample nearest to the horizon. Horizons that are longer than all flights are omitted.
    */
  def of[S](plant: ObservedPlant[S], flights: Vector[TimeHistory]): Vector[HorizonError] =
    val flight = PlantFlight(plant)
    val states = flights.map(_.states(plant))
    for
      horizonS <- HorizonsS
      errors =
        for
          (flown, states) <- flights.zip(states)
          from            <- flown.starts(Identification.StartEveryS, horizonS)
          position        <- atHorizon(flight, states(from), flown, from, horizonS)
        yield position
      if errors.nonEmpty
    yield
      val (position, velocity) = (errors.map(_._1).sorted, errors.map(_._2).sorted)
      HorizonError(
        horizonS,
        errors.size,
        quantile(position, 0.5),
        quantile(position, 0.95),
        quantile(velocity, 0.5),
        quantile(velocity, 0.95)
      )

  /** Simulates the full quadrotor from hovering at the first sample, with the recorded commands at their
    * times: the motion that a reduced model approximates. Samples are 0.1 s apart, each at the nearest whole
    * step.
    */
  def reflown(flown: TimeHistory, quadrotor: Quadrotor = Quadrotor.AirSim): TimeHistory =
    if flown.samples.isEmpty then flown
    else
      val first              = flown.samples.head
      val place              = Vector3(first.x, first.y, flown.downM)
      val state              = quadrotor.hovering(place)
      var setpoint: Setpoint = Setpoint.hold(place)
      var next               = 0
      val samples            = Vector.newBuilder[Sample]
      var nextSightS         = first.atS
      val steps              = ((flown.samples.last.atS - first.atS) / quadrotor.stepS).toInt
      for step <- 0 to steps do
        val atS = first.atS + step * quadrotor.stepS
        if atS >= nextSightS - quadrotor.stepS / 2 then
          samples += Sample(atS, state.x, state.y, state.vx, state.vy)
          nextSightS += SampleEveryS
        while next < flown.arrivals.size && flown.arrivals(next).atS <= atS do
          setpoint = ActionGuidance.of(flown.arrivals(next).action).setpoint(state.kinematics)
          next += 1
        quadrotor.step(state, setpoint, Environment.Calm)
      flown.copy(samples = samples.result())

  private val SampleEveryS = 0.1

  /** Errors of position and velocity of one prediction, at the sample nearest to the horizon. */
  private def atHorizon[S](
      flight: PlantFlight[S],
      state: S,
      flown: TimeHistory,
      from: Int,
      horizonS: Double
  ): Option[(Double, Double)] =
    val goal    = flown.samples(from).atS + horizonS
    val nearest = flown.nearest(goal, from)
    Option(nearest)
      .filter(i => i > from && math.abs(flown.samples(i).atS - goal) <= SampleEveryS)
      .map: index =>
        val sample = flown.samples(index)
        // The tenth of a microsecond includes the nearest sample despite rounding.
        flown.predict(flight, state, from, sample.atS - flown.samples(from).atS + 1e-7)(_ => ())
        val predicted = flight.reading
        (
          StrictMath.hypot(predicted.northM - sample.x, predicted.eastM - sample.y),
          StrictMath.hypot(predicted.northMps - sample.vx, predicted.eastMps - sample.vy)
        )

  private def quantile(sorted: Vector[Double], p: Double): Double =
    sorted(((sorted.size - 1) * p).round.toInt)

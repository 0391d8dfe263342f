package skein.lanes.timetable

import java.util.Arrays
import scala.collection.mutable
import skein.forecast.{Forecast, Leg}
import skein.forward.{Grounds, LoopObserver}
import skein.fusion.{Exposure, SensorModel}
import skein.policy.Action
import skein.units.Instant

/** Records the events of an episode in their order. Readings and decisions count from 1 for each vehicle. */
private[lanes] final class TimetableNotes(
    models: Vector[TimetableDynamics],
    eyes: Map[Int, SensorModel],
    tellsMore: Boolean,
    end: OwnEnds
) extends LoopObserver:
  private val vehicles               = models.size
  val all: mutable.ArrayBuffer[Note] = mutable.ArrayBuffer.empty

  /** For each vehicle, the readings that were added to the forecast. */
  private val entered = Array.fill(vehicles)(mutable.ArrayBuffer.empty[Entered])

  // The last prediction: its forecast, the time of its decision, and its view.
  private var predictedOf: Forecast = null
  private var predictedAtNs         = 0L
  private var predicted             = 0

  /** For each vehicle, the number of readings so far, including predictions; and the number of decisions. */
  val looks, decisions: Array[Int] = Array.ofDim[Int](vehicles)

  /** By vehicle: when its reading of its first decision was sampled. */
  private val firstReadNs = Array.fill(vehicles)(Long.MinValue)

  /** The readings' numbers, by view, then by vehicle. */
  val views: mutable.ArrayBuffer[Array[Int]] = mutable.ArrayBuffer.empty

  private val readingOf  = Array.fill(vehicles)(mutable.ArrayBuffer.empty[Int])
  private val decisionOf = Array.fill(vehicles)(mutable.ArrayBuffer.empty[Int])
  private val placed     = Array.ofDim[Int](vehicles)

  private def look(vehicle: Int, timeS: Double, sensedNs: Long = -1): Int =
    looks(vehicle) += 1
    all += Note.Look(vehicle, timeS, looks(vehicle), sensedNs)
    looks(vehicle)

  /** Number of a view; several vehicles may decide on one view in sequence. */
  private def viewOf(seen: Array[Int]): Int =
    if views.isEmpty || !Arrays.equals(views.last, seen) then views += seen
    views.size - 1

  override def read(vehicle: Int, question: Int, atNs: Long, x: Double, y: Double, z: Double): Unit =
    val seen = readingOf(vehicle)
    while seen.size <= question do seen += 0
    seen(question) = look(vehicle, atNs * 1e-9, if models(vehicle).sensors.isEmpty then -1 else atNs)

  override def entered(
      vehicle: Int,
      question: Int,
      atNs: Long,
      validAtNs: Long,
      legs: => Vector[Leg]
  ): Unit =
    for predictor <- models(vehicle).predictor do
      val reading    = readingOf(vehicle)(question)
      val before     = entered(vehicle).lastOption
      val flown      = before.fold(Vector.empty)(_ => legs.map(plotted(vehicle, _)))
      val propagator = before.fold(predictor.propagator)(_.propagator.next(flown))
      if predictor.remembers then
        val way = before.fold(Propagation.Nothing)(_.propagator.predicted(flown))
        all += Note.Enter(vehicle, atNs * 1e-9, reading, before.fold(0)(_.reading), way)
      entered(vehicle) += Entered(reading, validAtNs, propagator)

  private def newest(vehicle: Int, forecast: Forecast): Entered =
    val validAt = forecast.tracks(vehicle).get.newest.validAt.toNanos
    entered(vehicle).findLast(_.validAtNs == validAt).get

  private def plotted(vehicle: Int, leg: Leg): Propagator.Leg =
    Propagator.Leg(leg.command.fold(0)(sent => decisionOf(vehicle)(sent.sequence.toInt)), leg.span)

  /** The view of all vehicles, predicted for the time at which a command that is sent now takes effect. */
  private def predict(forecast: Forecast, atNs: Long): Int =
    if (forecast ne predictedOf) || atNs != predictedAtNs then
      predictedOf = forecast
      predictedAtNs = atNs
      val legs = forecast.legsWhenActing(Instant.ofNanos(atNs)).get
      predicted = viewOf(Array.tabulate(vehicles): vehicle =>
        val start = newest(vehicle, forecast)
        looks(vehicle) += 1
        val way = start.propagator.predicted(legs(vehicle).map(plotted(vehicle, _)))
        all += Note.Predict(vehicle, atNs * 1e-9, looks(vehicle), start.reading, way)
        looks(vehicle))
    predicted

  override def decided(vehicle: Int, atNs: Long, elapsed: Double, upon: Grounds): Unit =
    val seen = upon.forecast match
      case Some(forecast) => predict(forecast, atNs)
      case None           => viewOf(Array.tabulate(vehicles)(each => readingOf(each)(upon.reading(each))))
    def ageS(of: Int) = (atNs - upon.validAtNs(of)) * 1e-9
    def aheadS        = upon.forecast.fold(-1.0): forecast =>
      val now = Instant.ofNanos(atNs)
      forecast.whenActing(now).get(vehicle).predictedFor.since(now).toSeconds.max(0)
    if firstReadNs(vehicle) == Long.MinValue then firstReadNs(vehicle) = upon.validAtNs(vehicle)
    val opponent = Option.when(vehicles == 2)(1 - vehicle)
    all += Note.Decide(
      vehicle,
      atNs * 1e-9,
      seen,
      decisions(vehicle),
      elapsed,
      opponent.fold(0)(upon.sentDecision),
      opponent.fold(0.0)(_ => ageS(vehicle)),
      opponent.fold(0.0)(ageS),
      Option.when(eyes.contains(vehicle))(aheadS),
      Option.when(tellsMore):
        val actsInS = aheadS.max(0)
        val timeS   = (atNs - firstReadNs(vehicle)) * 1e-9 + actsInS
        Note.More(upon.sentDecision.clone, Array.tabulate(vehicles)(ageS), actsInS, timeS)
    )
    decisions(vehicle) += 1
    if end != OwnEnds.None then mayEnd(atNs, upon, ageS)

  /** View of the last note of an end. */
  private var ended = -1

  private var begunNs = -1L

  private def mayEnd(atNs: Long, upon: Grounds, ageS: Int => Double): Unit =
    if begunNs < 0 then begunNs = atNs
    val view = viewOf(Array.tabulate(vehicles)(each => readingOf(each)(upon.reading(each))))
    // Several vehicles often decide on one view.
    if end == OwnEnds.ByTime || view != ended then
      ended = view
      all += Note.End(atNs * 1e-9, view, (atNs - begunNs) * 1e-9, Array.tabulate(vehicles)(ageS))

  private val orders = Array.fill(vehicles)(ImageOrder())

  override def exposed(vehicle: Int, number: Int, atNs: Long, image: Exposure): Unit =
    val seen = viewOf(Array.tabulate(vehicles)(look(_, atNs * 1e-9)))
    all += Note.Expose(
      vehicle,
      atNs * 1e-9,
      seen,
      number,
      SensorModel.normal(image.bearing),
      SensorModel.normal(image.range),
      image.found < eyes(vehicle).detection
    )
    orders(vehicle).taken(number, atNs)

  override def recognised(vehicle: Int, image: Int, atNs: Long): Unit =
    val order = orders(vehicle)
    order.known(image)
    all += Note.Join(vehicle, atNs * 1e-9, image, order.isOlder, order.last)

  override def commanded(vehicle: Int, number: Int, atNs: Long, action: Action): Unit =
    decisionOf(vehicle) += decisions(vehicle)

  override def acts(vehicle: Int, number: Int, atNs: Long): Unit =
    all += Note.Act(vehicle, atNs * 1e-9 + models(vehicle).deadTimeS, decisionOf(vehicle)(number)): Unit

  override def scored(timeS: Double, vehicle: Int, x: Double, y: Double, z: Double): Unit =
    placed(vehicle) = look(vehicle, timeS)
    if vehicle == vehicles - 1 then all += Note.Score(timeS, viewOf(placed.clone))

/** A reading in the forecast.
  *
  * @param propagator predicts from this reading
  */
private final case class Entered(reading: Int, validAtNs: Long, propagator: Propagator)

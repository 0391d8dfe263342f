package skein.lanes

import java.util.Arrays
import scala.collection.mutable
import skein.forecast.{Forecast, Leg}
import skein.forward.{Grounds, LoopObserver}
import skein.fusion.{Exposure, SensorModel}
import skein.units.Instant

/** Notes what happens, in the order in which it does. Readings and decisions count from 1 for each vehicle.
  */
private[lanes] final class TimetableNotes(vehicles: Int, model: LaneDynamics, eyes: Map[Int, SensorModel])
    extends LoopObserver:
  import TimetableKernel.{ACT, DECIDE, EXPOSE, JOIN, LOOK, PREDICT, SCORE}
  val all: mutable.ArrayBuffer[Note] = mutable.ArrayBuffer.empty

  /** By vehicle: the readings that entered the forecast. */
  private val entered = Array.fill(vehicles)(mutable.ArrayBuffer.empty[Entered])

  // What was predicted last: of which forecast, for a decision when, in which view.
  private var predictedOf: Forecast = null
  private var predictedAtNs         = 0L
  private var predicted             = 0

  /** By vehicle: how many there are, of what is predicted too. */
  val looks, decisions: Array[Int] = Array.ofDim[Int](vehicles)

  /** By view, then by vehicle: the readings' numbers. */
  val views: mutable.ArrayBuffer[Array[Int]] = mutable.ArrayBuffer.empty

  private val readingOf  = Array.fill(vehicles)(mutable.ArrayBuffer.empty[Int])
  private val decisionOf = Array.fill(vehicles)(mutable.ArrayBuffer.empty[Int])
  private val placed     = Array.ofDim[Int](vehicles)

  private def note(kind: Int, vehicle: Int, timeS: Double, number: Int): Note =
    all += Note(kind, vehicle, timeS, number)
    all.last

  private def look(vehicle: Int, timeS: Double): Int =
    looks(vehicle) += 1
    note(LOOK, vehicle, timeS, looks(vehicle)).number

  /** Several decide upon one view, one after the other. */
  private def viewOf(seen: Array[Int]): Int =
    if views.isEmpty || !Arrays.equals(views.last, seen) then views += seen
    views.size - 1

  override def read(vehicle: Int, question: Int, atNs: Long, x: Double, y: Double): Unit =
    val seen = readingOf(vehicle)
    while seen.size <= question do seen += 0
    seen(question) = look(vehicle, atNs * 1e-9)

  override def entered(vehicle: Int, question: Int, validAtNs: Long, legs: => Vector[Leg]): Unit =
    for predictor <- model.predictor do
      val propagator = entered(vehicle).lastOption
        .fold(predictor.propagator)(_.propagator.next(legs.map(plotted(vehicle, _))))
      entered(vehicle) += Entered(readingOf(vehicle)(question), validAtNs, propagator)

  /** The reading that a forecast starts from. */
  private def newest(vehicle: Int, forecast: Forecast): Entered =
    val validAt = forecast.tracks(vehicle).get.newest.validAt.toNanos
    entered(vehicle).findLast(_.validAtNs == validAt).get

  private def plotted(vehicle: Int, leg: Leg): Propagator.Leg =
    Propagator.Leg(leg.command.fold(0)(sent => decisionOf(vehicle)(sent.sequence.toInt)), leg.span)

  /** The view of where all vehicles will be when a command acts that is sent now. */
  private def predict(forecast: Forecast, atNs: Long): Int =
    if (forecast ne predictedOf) || atNs != predictedAtNs then
      predictedOf = forecast
      predictedAtNs = atNs
      val legs = forecast.legsWhenActing(Instant.ofNanos(atNs)).get
      predicted = viewOf(Array.tabulate(vehicles): vehicle =>
        val start = newest(vehicle, forecast)
        looks(vehicle) += 1
        val noted = note(PREDICT, vehicle, atNs * 1e-9, looks(vehicle))
        noted.from = start.reading
        noted.propagation = start.propagator.predicted(legs(vehicle).map(plotted(vehicle, _)))
        looks(vehicle))
    predicted

  override def decided(vehicle: Int, atNs: Long, elapsed: Double, upon: Grounds): Unit =
    val seen = upon.forecast match
      case Some(forecast) => predict(forecast, atNs)
      case None           => viewOf(Array.tabulate(vehicles)(each => readingOf(each)(upon.reading(each))))
    val noted = note(DECIDE, vehicle, atNs * 1e-9, decisions(vehicle))
    decisions(vehicle) += 1
    noted.view = seen
    noted.elapsedS = elapsed
    if vehicles == 2 then
      noted.opponent = upon.sentDecision(1 - vehicle)
      noted.ownAgeS = (atNs - upon.validAtNs(vehicle)) * 1e-9
      noted.opponentAgeS = (atNs - upon.validAtNs(1 - vehicle)) * 1e-9
    if eyes.contains(vehicle) then
      noted.opponentAgeS = atNs * 1e-9
      noted.aheadS = upon.forecast.fold(-1.0): forecast =>
        val now = Instant.ofNanos(atNs)
        forecast.whenActing(now).get(vehicle).predictedFor.since(now).toSeconds.max(0)

  /** Of each vehicle's images. */
  private val orders = Array.fill(vehicles)(ImageOrder())

  override def exposed(vehicle: Int, number: Int, atNs: Long, image: Exposure): Unit =
    val seen  = viewOf(Array.tabulate(vehicles)(look(_, atNs * 1e-9)))
    val noted = note(EXPOSE, vehicle, atNs * 1e-9, number)
    noted.view = seen
    noted.elapsedS = SensorModel.normal(image.bearing)
    noted.ownAgeS = SensorModel.normal(image.range)
    noted.opponentAgeS = if image.found < eyes(vehicle).detection then 1 else 0
    orders(vehicle).taken(number, atNs)

  override def recognised(vehicle: Int, image: Int, atNs: Long): Unit =
    val order = orders(vehicle)
    order.known(image)
    val noted = note(JOIN, vehicle, atNs * 1e-9, image)
    noted.opponent = if order.isOlder then 1 else 0
    noted.from = order.last

  override def commanded(
      vehicle: Int,
      number: Int,
      atNs: Long,
      headingRad: Double,
      speedMps: Double
  ): Unit = decisionOf(vehicle) += decisions(vehicle)

  override def acts(vehicle: Int, number: Int, atNs: Long): Unit =
    note(ACT, vehicle, atNs * 1e-9 + model.deadTimeS, decisionOf(vehicle)(number)): Unit

  override def scored(timeS: Double, vehicle: Int, x: Double, y: Double): Unit =
    placed(vehicle) = look(vehicle, timeS)
    if vehicle == vehicles - 1 then
      note(SCORE, 0, timeS, 0).view = viewOf(placed.clone)

/** Something that happens.
  *
  * @param kind of [[TimetableKernel]]'s operations
  * @param agent the vehicle
  * @param atS a decision's: not before
  * @param number `LOOK`: the reading's. `ACT`: the decision's. `DECIDE`: that of the decision before; the new
  *   one's is one more. `EXPOSE` and `JOIN`: the image's
  */
private[lanes] final class Note(val kind: Int, val agent: Int, val atS: Double, val number: Int):
  /** Of a decision; of an image the errors, and whether what is in view is found. */
  var elapsedS, ownAgeS, opponentAgeS = 0.0

  /** Of a decision by who sees: until when what is believed is carried on. */
  var aheadS = 0.0

  /** `DECIDE`, `SCORE` and `EXPOSE`: the view's number. */
  var view = 0

  /** `DECIDE` in a duel: the number of the opponent's decision that is known. `JOIN`: 1 for an image that is
    * older than the one that joined before.
    */
  var opponent = 0

  /** `PREDICT`: the number of the reading that is carried forward. `JOIN`: the image that joined before. */
  var from = 0

  /** `PREDICT`: the way to the moment predicted. */
  var propagation: Propagation = Propagation.Nowhere

/** A reading in the forecast.
  *
  * @param propagator for what is predicted from it
  */
private final case class Entered(reading: Int, validAtNs: Long, propagator: Propagator)

package skein.loop

import scala.compiletime.ops.int.-
import scala.compiletime.{constValueTuple, summonAll}
import scala.deriving.Mirror
import skein.planning.*
import skein.scenario.{Fence, Kept}
import skein.units.*
import skein.vehicle.ReducedModel

/** How `plan` plans.
  *
  * @param deadline from the tick until the command leaves, whatever was found by then
  * @param horizonSteps of `step` each
  * @param method `cross-entropy` or `path-integral`
  * @param behaviours of the opponent, against which every candidate is flown
  * @param searches side by side: as many threads as that in real time
  * @param slices of each search in virtual time, where the clock does not end it; several vehicles share
  *   them, and get one each at least
  * @param blocksPerSlice 128 candidates each; between two slices a search looks whether its time is over
  * @param turningRadiusM of a vehicle at the speed that it commands
  * @param slowestShare of its speed that a vehicle may be commanded; 1: only its heading is planned
  * @param separationM to be kept from vehicles that are not the opponent; 0: none
  * @param geofenceM to be kept to north and south, east and west of the origin; 0: none
  * @param kept of the scenario's limits, with a margin of [[PlanSettings.Doubt]], of speeds
  *   [[PlanSettings.SpeedDoubt]]; not in the text
  * @param response of the vehicles to their commands
  */
final case class PlanSettings(
    deadline: Span = Span.ofMillis(60),
    horizonSteps: Int = 30,
    step: Span = Span.ofMillis(100),
    method: String = PlanSettings.CrossEntropy,
    behaviours: Int = 3,
    searches: Int = 2,
    slices: Int = 4,
    blocksPerSlice: Int = PlanSettings.defaultBlocks,
    turningRadiusM: Double = 8,
    slowestShare: Double = 1,
    separationM: Double = 0,
    geofenceM: Double = 0,
    kept: Vector[Kept] = Vector.empty,
    response: ReducedModel = ReducedModel.AirSim
):
  /** What cannot be flown. */
  def mistakes: Seq[String] =
    def check(name: String, value: Any, isRight: Boolean, expected: String) =
      Option.when(!isRight)(s"$name: expected $expected, came $value")
    Seq(
      check("deadline", s"${deadline.toMillis} ms", deadline > Span.Zero, "more than 0"),
      check("horizonSteps", horizonSteps, horizonSteps > 0 && horizonSteps <= 200, "1 to 200"),
      check(
        "step",
        s"${step.toMillis} ms",
        step >= Span.ofMillis(10) && step <= Span.ofMillis(500),
        "10 to 500 ms"
      ),
      check(
        "method",
        method,
        PlanSettings.methods.contains(method),
        PlanSettings.methods.keys.toSeq.sorted.mkString(" or ")
      ),
      check("behaviours", behaviours, behaviours > 0 && behaviours <= 32, "1 to 32"),
      check("searches", searches, searches > 0 && searches <= 64, "1 to 64"),
      check("slices", slices, slices > 0, "1 or more"),
      check("blocksPerSlice", blocksPerSlice, blocksPerSlice > 0, "1 or more"),
      check("turningRadiusM", turningRadiusM, turningRadiusM > 0, "more than 0"),
      check("slowestShare", slowestShare, slowestShare >= 0 && slowestShare <= 1, "0 to 1"),
      check("separationM", separationM, separationM >= 0, "0 or more"),
      check("geofenceM", geofenceM, geofenceM >= 0, "0 or more")
    ).flatten

  /** [[response]] of a vehicle at this altitude; the one that AirSim's quadrotor has by default depends on
    * it.
    */
  def responseAt(altitudeM: Double): ReducedModel =
    if response == ReducedModel.AirSim then ReducedModel.airSimAt(altitudeM) else response

  def planner: PlannerSettings =
    PlannerSettings(
      horizonSteps,
      step.toSeconds,
      PlanSettings.methods(method),
      blocksPerSlice,
      stepsPerKnot = 3
    )

  def geofences: Vector[Geofence] =
    Option.when(geofenceM > 0)(Geofence(Fence.rectangle(
      -geofenceM,
      geofenceM,
      -geofenceM,
      geofenceM
    ))).toVector ++
      kept.collect { case Kept.Inside(fence) => Geofence(fence, PlanSettings.Doubt) }

  /** What the scenario says that any two vehicles keep between them, opponents too, m; 0: nothing. */
  def apartM: Double = kept.collect { case Kept.Apart(leastM) => leastM }.maxOption.getOrElse(0)

  /** The fastest that a vehicle is commanded which would be commanded so much, m/s. */
  def speedMps(ownMps: Double): Double =
    kept.collect { case Kept.NoFaster(mostMps) => mostMps * (1 - PlanSettings.SpeedDoubt) }.foldLeft(ownMps)(
      _ min _
    )

  /** The altitude nearest to a vehicle's own between floor and ceiling; midway where these are close, m. */
  def altitudeM(ownM: Double): Double =
    val leastM = kept.collect { case Kept.Above(leastM) => leastM + PlanSettings.Doubt }.maxOption
    val mostM  = kept.collect { case Kept.Below(mostM) => mostM - PlanSettings.Doubt }.minOption
    (leastM, mostM) match
      case (Some(least), Some(most)) if least > most => (least + most) / 2
      case _ => ownM.max(leastM.getOrElse(ownM)).min(mostM.getOrElse(Double.PositiveInfinity))

  /** As [[PlanSettings.parse]] reads it back, apart from the response. */
  def text: String = PlanSettings.words
    .zip(productIterator)
    .map { case ((field, word), value) => s"${word.name(field)}=${word.text(value)}" }
    .mkString(" ")

object PlanSettings:
  val CrossEntropy = "cross-entropy"
  val PathIntegral = "path-integral"

  /** On top of what is set, since vehicles do not follow their models exactly and commands come at other
    * times than expected, m.
    */
  val Doubt = 1.0

  /** The same of speeds, as a share: vehicles swing past what they are commanded. */
  val SpeedDoubt = 0.1

  private val methods = Map(
    CrossEntropy -> PlanMethod.CrossEntropy(elites = 48, smoothing = 0.2),
    PathIntegral -> PlanMethod.PathIntegral(temperature = 0.1)
  )

  /** Work for a tenth of a millisecond with lanes, for two without. */
  val defaultBlocks: Int = if Planner.isFast then 4 else 1

  /** A setting as a word of the text. */
  private final class Word[A](suffix: String, val text: A => String, parse: String => Option[A]):
    def name(field: String): String                                 = field + suffix
    def read(values: Map[String, String], field: String): Option[A] = values.get(name(field)).flatMap(parse)

  private given Word[Span]   = Word("Ns", _.toNanos.toString, _.toLongOption.map(Span.ofNanos))
  private given Word[Int]    = Word("", _.toString, _.toIntOption)
  private given Word[Double] = Word("", _.toString, _.toDoubleOption)
  private given Word[String] = Word("", identity, Some(_))

  private val mirror = summon[Mirror.ProductOf[PlanSettings]]

  /** All settings but the last two, by their names. */
  private val words: Vector[(String, Word[Any])] =
    constValueTuple[mirror.MirroredElemLabels].toList.map(_.toString).toVector.zip(
      summonAll[Tuple.Map[
        Tuple.Take[mirror.MirroredElemTypes, Tuple.Size[mirror.MirroredElemTypes] - 2],
        Word
      ]].toList.asInstanceOf[List[Word[Any]]]
    )

  /** Reads settings back from their text; absent where that is no such text. */
  def parse(text: String): Option[PlanSettings] =
    val values = text.split(' ').collect { case s"$name=$value" => name -> value }.toMap
    val read   = words.flatMap((field, word) => word.read(values, field))
    Option
      .when(read.size == words.size)(PlanSettings())
      .map(usual => mirror.fromProduct(Tuple.fromArray((read ++ Seq(usual.kept, usual.response)).toArray)))
      .filter(_.mistakes.isEmpty)

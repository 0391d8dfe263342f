package skein.loop

import scala.compiletime.{constValueTuple, summonAll}
import scala.deriving.Mirror
import skein.planning.*
import skein.scenario.{Fence, Kept, Scenario}
import skein.units.*

/** Settings of the loop `plan`.
  *
  * @param deadline time from the tick until the command is sent, with the best plan found by then
  * @param horizonSteps number of steps, of duration `step` each
  * @param behaviours number of behaviours of the opponent against which every candidate is simulated
  * @param searches number of concurrent searches: of threads in real time
  * @param slices number of slices of each search in virtual time, where the clock does not end it; several
  *   vehicles share them, and each gets at least one
  * @param blocksPerSlice number of blocks of 128 candidates in a slice, which takes some 0.1 ms; between two
  *   slices a search checks its time
  * @param turningRadiusM turning radius of a vehicle at its commanded speed, m
  * @param slowestShare minimum commanded speed, as a fraction of the vehicle's speed; 1: only its heading is
  *   planned
  * @param separationM separation to be kept from vehicles other than the opponent, m; 0: none
  * @param geofenceM maximum distance from the origin to north and south, east and west, m; 0: none
  * @param kept the scenario's limits that plans keep, with the margin [[PlanSettings.Doubt]], or
  *   [[PlanSettings.SpeedDoubt]] of speeds; not part of the text
  */
final case class PlanSettings(
    deadline: Span = Span.ofMillis(60),
    horizonSteps: Int = 30,
    step: Span = Span.ofMillis(100),
    behaviours: Int = 3,
    searches: Int = 2,
    slices: Int = 4,
    blocksPerSlice: Int = 4,
    turningRadiusM: Double = 8,
    slowestShare: Double = 1,
    separationM: Double = 0,
    geofenceM: Double = 0,
    kept: Vector[Kept] = Vector.empty
):
  /** The settings with invalid values, one line each. */
  def mistakes: Seq[String] =
    def check(name: String, value: Any, isRight: Boolean, expected: String) =
      Option.when(!isRight)(s"$name: expected $expected, got $value")
    Seq(
      check(
        "deadline",
        s"${deadline.toMillis} ms",
        deadline > Span.Zero && deadline <= PlanSettings.MostDeadline,
        s"more than 0 and at most ${PlanSettings.MostDeadline.toMillis} ms"
      ),
      check("horizonSteps", horizonSteps, horizonSteps > 0 && horizonSteps <= 200, "1 to 200"),
      check(
        "step",
        s"${step.toMillis} ms",
        step >= Span.ofMillis(10) && step <= Span.ofMillis(500),
        "10 to 500 ms"
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

  def planner: PlannerSettings =
    PlannerSettings(horizonSteps, step.toSeconds, blocksPerSlice = blocksPerSlice, stepsPerKnot = 3)

  def geofences: Vector[Geofence] =
    Option.when(geofenceM > 0)(Geofence(Fence.rectangle(
      -geofenceM,
      geofenceM,
      -geofenceM,
      geofenceM
    ))).toVector ++
      kept.collect { case Kept.Inside(fence) => Geofence(fence, PlanSettings.Doubt) }

  /** These settings with a scenario's limits, except those of custom quantities. */
  def keeping(scenario: Scenario): PlanSettings = copy(kept = scenario.limits.flatMap(_.kept))

  /** The separation of any two vehicles in the scenario's limits, opponents included, m; 0 if there is none.
    */
  def apartM: Double = kept.collect { case Kept.Apart(leastM) => leastM }.maxOption.getOrElse(0)

  /** A vehicle's speed limited by the scenario's limits, m/s. */
  def speedMps(ownMps: Double): Double =
    kept.collect { case Kept.NoFaster(mostMps) => mostMps * (1 - PlanSettings.SpeedDoubt) }.foldLeft(ownMps)(
      _ min _
    )

  /** The altitude nearest to a vehicle's own between floor and ceiling, m; midway between them if they are
    * close.
    */
  def altitudeM(ownM: Double): Double =
    val leastM = kept.collect { case Kept.Above(leastM) => leastM + PlanSettings.Doubt }.maxOption
    val mostM  = kept.collect { case Kept.Below(mostM) => mostM - PlanSettings.Doubt }.minOption
    (leastM, mostM) match
      case (Some(least), Some(most)) if least > most => (least + most) / 2
      case _ => ownM.max(leastM.getOrElse(ownM)).min(mostM.getOrElse(Double.PositiveInfinity))

  def text: String = PlanSettings.words
    .zip(productIterator)
    .map { case ((name, word), value) => s"$name=${word.text(value)}" }
    .mkString(" ")

object PlanSettings:
  /** Maximum deadline: after a longer search, the data behind a plan would be older than in any other loop.
    */
  val MostDeadline: Span = Span.ofSeconds(2)

  /** Margin added to the separation, since vehicles deviate from their models and commands arrive at other
    * times than expected, m.
    */
  val Doubt = 1.0

  /** Margin of speed limits, as a share: vehicles overshoot commanded speeds. */
  val SpeedDoubt = 0.1

  /** The text form of a setting: one word, after its name with this suffix. */
  private final class Word[A](val suffix: String, val text: A => String, val parse: String => Option[A])

  private given Word[Span]   = Word("Ns", _.toNanos.toString, _.toLongOption.map(Span.ofNanos))
  private given Word[Int]    = Word("", _.toString, _.toIntOption)
  private given Word[Double] = Word("", _.toString, _.toDoubleOption)

  private val mirror = summon[Mirror.ProductOf[PlanSettings]]

  /** All settings by name, except the last, which the scenario sets. */
  private val words: Vector[(String, Word[Any])] =
    constValueTuple[mirror.MirroredElemLabels].toList.toVector
      .zip(summonAll[Tuple.Map[Tuple.Init[mirror.MirroredElemTypes], Word]].toList)
      .map { case (field, word: Word[Any] @unchecked) => s"$field${word.suffix}" -> word }

  /** Reads settings back from their text; absent if it is not such a text. */
  def parse(text: String): Option[PlanSettings] =
    val values = text.split(' ').collect { case s"$name=$value" => name -> value }.toMap
    val read   = words.flatMap((name, word) => values.get(name).flatMap(word.parse))
    Option
      .when(read.size == words.size)(mirror.fromProduct(Tuple.fromArray((read :+ Vector.empty).toArray)))
      // Plans were searched by path integrals, too.
      .filter(read => read.mistakes.isEmpty && values.get("method").forall(_ == "cross-entropy"))

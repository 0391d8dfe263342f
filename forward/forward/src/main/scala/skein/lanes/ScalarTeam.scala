package skein.lanes

import scala.collection.immutable.ArraySeq
import scala.collection.mutable.ArrayBuilder
import skein.forward.{Delays, LoopObserver, LoopTiming, Rollout, VelocityResponse}
import skein.lanes.score.{Effort, Judged, OfMoment}
import skein.scenario.{Positions, Quantity, Reduction}

/** Simulates teams one world at a time: the scalar reference. Mutable.
  *
  * @param model creates the response of the vehicles of one rollout
  */
private[skein] final class ScalarTeam(timing: LoopTiming, model: => VelocityResponse):
  private var last: (TeamCandidate, Delays) = (null, null)
  private var rollout: Rollout              = null
  private var tallies: Vector[Tally]        = Vector.empty

  /** Simulates one episode and returns its scores. */
  def fly(candidate: TeamCandidate, link: Delays, key: Int): Vector[Double] =
    start(candidate, link, key).flyUntil(Rollout.Never): Unit
    values

  private[lanes] def start(candidate: TeamCandidate, link: Delays, key: Int): Rollout =
    val asked = (candidate, link)
    if asked != last then
      last = asked
      rollout = Rollout(candidate.engagement, timing, link, model)
    tallies = candidate.quantities.map(Tally(_))
    rollout.start(key, Judging(candidate))
    rollout

  /** The finished episode's scores, in their order. */
  private[lanes] def values: Vector[Double] =
    val next = tallies.iterator
    last._1.judged.map:
      case Effort(vehicle) => rollout.controllers(vehicle).effortRad
      case _: Judged       => next.next().value

  /** Of a flight that ends before a score begins, all of it counts. */
  private final class Judging(candidate: TeamCandidate) extends LoopObserver:
    private val mayEnd               = candidate.engagement.isOver.nonEmpty
    private val count                = candidate.engagement.agents.size
    private val northM, eastM, downM = Array.ofDim[Double](count)

    override def scored(timeS: Double, vehicle: Int, x: Double, y: Double, z: Double): Unit =
      northM(vehicle) = x; eastM(vehicle) = y; downM(vehicle) = z
      if vehicle == count - 1 && (mayEnd || candidate.quantities.exists(_.counts(timeS))) then
        val places = Positions(IArray.from(northM), IArray.from(eastM), IArray.from(downM), timeS)
        for tally <- tallies if mayEnd || tally.judged.counts(timeS) do
          if tally.judged.counts(timeS) then tally.begin()
          tally.add(timeS, Quantity.told(tally.judged.quantity, places))

private[skein] object ScalarTeam:
  private[lanes] val Worlds = 16

/** Computes a score of one episode from its values. Mutable. */
private final class Tally(val judged: Judged):
  private val values = ArrayBuilder.ofDouble()
  private val timesS = ArrayBuilder.ofDouble()
  private var firstS = Double.PositiveInfinity
  private var begun  = false

  /** Forgets what was added before the score's time. */
  def begin(): Unit =
    if !begun then
      begun = true
      values.clear()
      timesS.clear()
      firstS = Double.PositiveInfinity

  def add(timeS: Double, value: Double): Unit = judged.reduction match
    case OfMoment.FirstWithin(limit) => if value <= limit then firstS = firstS.min(timeS)
    case _                           => values += value; timesS += timeS

  /** The score of the values so far; NaN if there were none. */
  def value: Double =
    def all = ArraySeq.unsafeWrapArray(values.result())
    judged.reduction match
      case OfMoment.FirstWithin(_) => firstS
      case _ if values.length == 0 => Double.NaN
      case OfMoment.Newest         => all.last
      case reduction: Reduction    => reduction.of(all, timesS.result(), judged.everyS)

/** Steps the vehicles of many teams together, with the loops of the scalar reference. Mutable. */
private final class SteppedTeams(timing: LoopTiming, stepped: SteppedRollouts):
  private val teams = Array.tabulate(stepped.worlds)(lane => ScalarTeam(timing, stepped.vehiclesOf(lane)))

  def fly(worlds: TeamWorlds, numbers: Array[Int], into: TeamOutcomes): Unit =
    for some <- numbers.grouped(stepped.worlds) do
      stepped.fly(some.length): lane =>
        val world = some(lane)
        teams(lane).start(worlds.candidate(world), worlds.link(world), worlds.key(world))
      for lane <- some.indices do into.set(some(lane), teams(lane).values)

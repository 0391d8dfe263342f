package skein.lanes

import scala.collection.mutable.ArrayBuffer
import skein.forward.{Delays, LoopObserver, LoopTiming, Rollout, VelocityResponse}
import skein.scenario.{Positions, Quantity}

/** The scalar reference for a team's results. Mutable.
  *
  * @param model of the vehicles of one rollout
  */
private[skein] final class ScalarTeam(timing: LoopTiming, model: => VelocityResponse):
  private var last: (TeamCandidate, Delays)                = (null, null)
  private var rollout: Rollout                             = null
  private var found: Vector[ArrayBuffer[(Double, Double)]] = Vector.empty

  /** Simulates one episode; returns its values of the judged numbers. */
  def fly(candidate: TeamCandidate, link: Delays, key: Int): Vector[Double] =
    start(candidate, link, key).flyUntil(Rollout.Never): Unit
    values

  private[lanes] def start(candidate: TeamCandidate, link: Delays, key: Int): Rollout =
    val asked = (candidate, link)
    if asked != last then
      last = asked
      rollout = Rollout(candidate.engagement, timing, link, model)
    found = candidate.judged.map(_ => ArrayBuffer.empty)
    rollout.start(key, 0, Judging(candidate))
    rollout

  /** The results of the finished episode, one per judged number. */
  private[lanes] def values: Vector[Double] =
    last._1.judged.zip(found).map((each, at) => each.of(at.toVector))

  private final class Judging(candidate: TeamCandidate) extends LoopObserver:
    private val count                = candidate.engagement.agents.size
    private val northM, eastM, downM = Array.ofDim[Double](count)

    override def scored(timeS: Double, vehicle: Int, x: Double, y: Double, z: Double): Unit =
      northM(vehicle) = x; eastM(vehicle) = y; downM(vehicle) = z
      if vehicle == count - 1 && candidate.judged.exists(_.counts(timeS)) then
        val places = Positions(IArray.from(northM), IArray.from(eastM), IArray.from(downM))
        for (each, at) <- candidate.judged.zip(found) if each.counts(timeS) do
          at += ((timeS, Quantity.told(each.quantity, places)))

/** Simulates a team's vehicles side by side, and their loops by the scalar reference. Mutable. */
private final class SteppedTeams(timing: LoopTiming, stepped: SteppedRollouts):
  private val teams = Array.tabulate(stepped.worlds)(lane => ScalarTeam(timing, stepped.vehiclesOf(lane)))

  def fly(worlds: TeamWorlds, numbers: Array[Int], into: TeamOutcomes): Unit =
    for some <- numbers.grouped(stepped.worlds) do
      stepped.fly(some.length): lane =>
        val world = some(lane)
        teams(lane).start(worlds.candidate(world), worlds.link(world), worlds.key(world))
      for lane <- some.indices do into.set(some(lane), teams(lane).values)

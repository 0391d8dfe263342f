package skein.lanes

import skein.forward.{Delays, Pair, LoopTiming, TabledDelays, VelocityResponse}
import skein.lanes.loop.{LoopEye, LoopKernel, LoopLanes}
import skein.lanes.policy.{CameraTrackerLanes, LanePolicy}
import skein.lanes.score.{Judged, Scoreboard, ScoreLanes}
import skein.lanes.timetable.{Timetable, TimetableEye, TimetableKernel}

/** Values of the last flight of a kernel for duels, in each of its worlds. */
final class PairKernel(
    duel: Pair,
    timing: LoopTiming,
    captureM: Float,
    members: Array[? <: TeamMember],
    scores: Scoreboard
):
  private val judged =
    PairNumber.values.toVector.filter(_.judged(duel, timing, captureM).isInstanceOf[Judged])

  def apply(number: PairNumber): Array[Float] = number match
    case PairNumber.EvaderEffort  => members(0).effortRad
    case PairNumber.PursuerEffort => members(1).effortRad
    case _                        => scores.values(judged.indexOf(number))

/** Kernels for duels with a separate policy for each vehicle; the evader is the first. */
object PairKernels:
  val WORLDS: Int = LanePolicy.WORLDS

  private def scoreboard(duel: Pair, timing: LoopTiming, captureM: Float): Scoreboard =
    val judged = PairNumber.values.toVector.map(_.judged(duel, timing, captureM)).collect {
      case each: Judged =>
        each
    }
    Scoreboard(ScoreLanes.of(judged, 2).fold(throw _, identity), Vector(0, 0))

  /** Candidates that share one episode. */
  def shared(
      duel: Pair,
      timing: LoopTiming,
      model: VelocityResponse,
      policies: Vector[LanePolicy],
      link: Delays,
      key: Int,
      captureM: Float,
      eyes: Map[Int, TimetableEye] = Map.empty
  ): PairKernel =
    val vehicles = LaneDynamics.under(timing, model).fold(munit.Assertions.fail(_), identity)
    val both     = Vector.fill(2)(vehicles)
    val members  = Opponents.inEpisode(Vector(duel.evader, duel.pursuer), both, policies, eyes)
    val scores   = scoreboard(duel, timing, captureM)
    val sensors  = Vector(duel.evader, duel.pursuer).map(_.eye).zipWithIndex.collect {
      case (Some(eye), self) =>
        self -> eye
    }.toMap
    val timetable = Timetable.of(both, duel.durationS, timing, link, key, sensors)
    for self <- members.indices do members(self).vehicles.seed(Array.fill(WORLDS)(key.toLong), self)
    TimetableKernel(members.map(identity), scores).fly(timetable, WORLDS)
    PairKernel(duel, timing, captureM, members, scores)

  /** Worlds with separate delays. */
  def alone(
      duel: Pair,
      timing: LoopTiming,
      model: VelocityResponse,
      policies: Vector[LanePolicy],
      links: Array[TabledDelays],
      keys: Array[Int],
      captureM: Float,
      newEye: Opponents.NewEye = LoopEye(_, _, _, _, _, _),
      shortCut: Boolean = true
  ): PairKernel =
    val vehicles = Vector.fill(2)(LaneDynamics.under(timing, model).fold(munit.Assertions.fail(_), identity))
    munit.Assertions.assertEquals(
      links.distinct.flatMap(LoopSupport.refusal(timing, vehicles, _)).toSeq,
      Nil
    )
    val agents  = Vector(duel.evader, duel.pursuer)
    val cameras = agents.map(_.eye).zipWithIndex.collect { case (Some(eye), self) =>
      self -> CameraTrackerLanes.of(eye).fold(munit.Assertions.fail(_), identity)
    }.toMap
    val loop = LoopLanes(
      timing,
      vehicles.map(_.predictor),
      duel.durationS,
      links.map(_.maxS).max,
      cameras.nonEmpty,
      vehicles.map(_.sensors),
      shortCut
    )
    val (members, eye) = Opponents.inLoop(agents, loop, vehicles, policies, cameras, newEye)
    val scores         = scoreboard(duel, timing, captureM)
    val kernel         = LoopKernel(loop, members.map(identity), scores)
    eye.foreach(_.start(keys, links))
    kernel.fly(keys, links)
    PairKernel(duel, timing, captureM, members, scores)

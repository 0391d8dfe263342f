package skein.lanes

import skein.forward.{
  DelayTable,
  Delays,
  Duel,
  LoopTiming,
  VelocityResponse
}
import skein.lanes.policy.PolicyLanes
import skein.lanes.timetable.Timetables
import skein.policy.HeadingPolicy
import skein.simd.LaneMath
import skein.units.Expect

/** Simulates many duels under one loop's timing, on all cores: the entry point of forward simulation for
  * searches and maps.
  *
  * Every policy that is a formula runs on SIMD ([[PolicyLanes]]): worlds that share episodes by
  * [[skein.lanes.timetable.TimetableKernel]], others by [[LoopDuelKernel]]. Quadrotors of other worlds are
  * stepped by SIMD under the scalar loops ([[SteppedRollouts]]). All else runs on the scalar reference
  * ([[Rollout]]). `docs/engines.md` has the table. The engine of a world depends on the world and on
  * `shareEpisodes` alone, so results do not depend on threads, on a call's other worlds or on their order.
  * One call at a time.
  *
  * @param duel start, speeds and duration; the policies come from the worlds
  * @param accelerator simulates the candidates of [[Worlds.episodesOfEach]] whose policies are formulas, if
  *   it supports the loop and the vehicles
  * @param isReference uses the scalar reference alone, to compare others with it
  */
final class DuelBatch(
    duel: Duel,
    timing: LoopTiming,
    model: VelocityResponse,
    threads: Int = Runtime.getRuntime.availableProcessors,
    accelerator: Option[Accelerator] = None,
    isReference: Boolean = false
):
  require(threads > 0, s"threads must be positive, got $threads")

  private val vehicles = Seq(duel.evader, duel.pursuer)

  private val plant: Either[String, LaneDynamics] =
    for
      _     <- LaneSupport.present
      _     <- Expect.that(!isReference)("the reference was asked for")
      plant <- LaneDynamics.of(model, duel)
    yield plant

  private val eyes: Either[String, DuelEyes] = DuelEyes.of(duel)

  /** Whether some agent knows the other by a sensor alone. */
  private val sees = duel.pursuer.eye.isDefined || duel.evader.eye.isDefined

  /** The episodes, if timetables support them. */
  private val lanes: Either[String, DuelEpisodes] =
    for
      _     <- plant
      eyes  <- eyes
      lanes <- LaneDynamics.under(timing, model, duel)
    yield DuelEpisodes(duel, timing, lanes, eyes)

  /** The vehicles and cameras, if SIMD supports them with separate delays in every world. */
  private val apart: Either[String, (LaneDynamics, DuelEyes)] =
    for
      plant <- plant
      eyes  <- eyes
      _     <- Expect.that(!sees || plant.fliesAlone):
        "quadrotors of which one sees by a sensor fly by lanes where candidates share episodes"
      _ <- Expect.that(!sees || !timing.isInstanceOf[LoopTiming.Paused]):
        "who sees by a sensor while the world waits flies by lanes where candidates share episodes"
      _ <- Expect.that(eyes.pursuer.isEmpty || eyes.evader.isEmpty):
        "two that see one another by sensors fly by lanes where candidates share episodes"
    yield (plant, eyes)

  private final class Worker:
    val scalar: DuelFlyer = ScalarFlyer(duel, timing, model)
    val alone: DuelFlyer  =
      SteppedRollouts.of(
        model,
        vehicles
      ).filterNot(_ => sees || isReference).map(SteppedFlyer(duel, timing, _)).getOrElse:
        apart.fold(_ => scalar, LoopFlyer(duel, timing, _, _, scalar))
    val together: DuelFlyer = lanes.fold(_ => alone, TimetableFlyer(_, timetables, alone))

  private val timetables = Timetables()
  private val workers    = Vector.fill(threads)(Worker())

  private val accelerated: Option[Either[String, AcceleratedDuels]] =
    accelerator.map(each => lanes.flatMap(each.duels(_, model, threads)))

  /** The engine that steps vehicles side by side, if any. */
  private val stepped: Option[Engine] =
    SteppedRollouts.engine(model, vehicles).filterNot(_ => sees || isReference)

  /** Whether worlds share episodes. A world that waits for its controller has no delays: all worlds share
    * their episode, except for what cameras detect.
    */
  private def shares(asked: Boolean): Boolean = asked || timing.isInstanceOf[LoopTiming.Paused] && !sees

  /** The engine for worlds of these policies.
    *
    * @param shareEpisodes see [[DuelWorlds.shareEpisodes]]; on a GPU, only worlds with
    *   [[Worlds.episodesOfEach]] run
    * @param links of the worlds: SIMD does not support delays that are long for the period, or recorded
    */
  def engine(
      pursuer: HeadingPolicy,
      evader: HeadingPolicy,
      shareEpisodes: Boolean,
      links: Seq[Delays]
  ): Engine =
    val together = shares(shareEpisodes)
    Engine.of(
      lanesOf(pursuer, evader, together),
      links.map(refusal(together, _)),
      stepped,
      Accelerator.engine(accelerator, accelerated, together),
      LaneMath.LANES
    )

  private def refusal(shareEpisodes: Boolean, link: Delays): Option[String] =
    if shareEpisodes && lanes.isRight then None
    else apart.fold(Some(_), (plant, _) => LoopSupport.refusal(timing, 2, link, plant))

  /** What flies by lanes over links that the lanes know, or why nothing does. */
  private def lanesOf(
      pursuer: HeadingPolicy,
      evader: HeadingPolicy,
      shareEpisodes: Boolean
  ): Either[String, String] =
    for
      _ <- plant
      _ <- Seq(pursuer, evader)
        .flatMap(PolicyLanes.of(_).left.toOption)
        .headOption
        .map(refused => s"a policy is no formula: ${refused.getMessage}")
        .toLeft(())
      _ <- if shareEpisodes then lanes else Right(())
      // Refused over the fastest link, it is over any.
      _ <- refusal(shareEpisodes, DelayTable.none).toLeft(())
    yield
      val worlds = if shareEpisodes then "candidates of an episode" else "worlds"
      s"${LaneMath.LANES} $worlds at a time"

  /** Simulates all worlds, unless it is cancelled.
    *
    * @param onProgress called with the number of worlds done, after each batch, by one thread at a time
    * @param isCancelled polled before each batch and in between, from any thread; running batches finish, or
    *   are abandoned where vehicles are stepped side by side
    * @throws InterruptedException if the caller is interrupted; running batches have finished then
    */
  def fly(
      worlds: DuelWorlds,
      captureRadiusM: Double = 0.0,
      onProgress: Int => Unit = _ => (),
      isCancelled: () => Boolean = () => false
  ): DuelOutcomes =
    val radiusM           = captureRadiusM.toFloat
    val outcomes          = DuelOutcomes(worlds.size, worlds.asked)
    val together          = shares(worlds.shareEpisodes)
    def flyer(of: Worker) = if together then of.together else of.alone
    val came              = Accelerated.first(accelerated, worlds, together):
      _.fly(worlds, radiusM, outcomes, onProgress, isCancelled)
    val most    = flyer(workers.head).batch
    val batches =
      if worlds.shareEpisodes then WorldBatches.byEpisode(worlds, came.left, most)
      else WorldBatches.inOrder(came.left, most)
    outcomes.flown = came.flown +
      LaneThreads.run(workers, batches, isCancelled, done => onProgress(came.flown + done)): (worker, some) =>
        flyer(worker).fly(worlds, some, radiusM, outcomes)
    outcomes

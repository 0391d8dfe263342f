package skein.lanes

import skein.forward.{DelayTable, Delays, Duel, LoopTiming, QuadrotorResponse, Reduced, VelocityResponse}
import skein.policy.Policy
import skein.simd.LaneMath

/** Flies many duels under one loop's timing, on all cores: the one front of forward simulation for searches and maps.
  *
  * Every policy that is a formula flies by lanes ([[PolicyLanes]]): worlds that share episodes with every model of a lag
  * and with the quadrotor, under any loop ([[TimetableKernel]]); other worlds with a [[Reduced]] model under
  * `LoopTiming.Stream` ([[StreamDuelKernel]]). Other worlds' quadrotors fly by lanes under the scalar loops
  * ([[QuadrotorFleet]]). All else flies by the scalar reference ([[Rollout]]). Which engine flies a world depends on the
  * world and on `shareEpisodes` alone, so results do not depend on threads, on a call's other worlds or on their order.
  * One call at a time.
  *
  * @param duel
  *   start, speeds and duration; the policies come from the worlds
  */
final class DuelBatch(
    duel: Duel,
    timing: LoopTiming,
    model: VelocityResponse,
    threads: Int = Runtime.getRuntime.availableProcessors
):
  require(threads > 0, s"threads must be positive, got $threads")

  private val plant: Either[String, TimetableModel] =
    LaneSupport.present.flatMap(_ => TimetableModel.of(model, duel))

  /** The vehicles under the loop, if it flies by timetables. */
  private val lanes: Either[String, TimetableModel] =
    plant.flatMap(_ => TimetableModel.under(timing, model, duel))

  /** One per thread. */
  private final class Worker:
    val scalar: DuelFlyer = ScalarFlyer(duel, timing, model)
    val alone: DuelFlyer  = (timing, model) match
      case (stream: LoopTiming.Stream, reduced: Reduced) if plant.isRight =>
        StreamFlyer(duel, stream, reduced, scalar)
      case (_, quadrotor: QuadrotorResponse) if plant.isRight => QuadrotorFleet(duel, timing, quadrotor)
      case _                                                  => scalar
    val together: DuelFlyer = lanes match
      case Right(kind) => TimetableFlyer(duel, timing, kind, timetables, alone)
      case _           => alone

  private val timetables = Timetables(MostBytes)
  private val workers    = Vector.fill(threads)(Worker())

  /** Which engine flies worlds of these policies, and why, in a line for the user.
    *
    * @param shareEpisodes
    *   see [[DuelWorlds.shareEpisodes]]
    * @param links
    *   that the worlds fly over: where delays are long for the period, or change in stretches, no lanes know them
    */
  def engine(pursuer: Policy, evader: Policy, shareEpisodes: Boolean, links: Seq[Delays]): String =
    lanesOf(pursuer, evader, shareEpisodes) match
      case Left(reason) => s"scalar: $reason"
      case Right(lanes) =>
        val refused = refusals(shareEpisodes, links)
        if refused.isEmpty then s"SIMD, $lanes"
        else if refused.size == links.size then s"scalar: ${refused.head}"
        else
          s"SIMD, $lanes, over ${links.size - refused.size} of ${links.size} links; scalar over the others: ${refused.head}"

  /** Whether all worlds of these policies fly by lanes, over any of the links. */
  def fliesByLanes(pursuer: Policy, evader: Policy, shareEpisodes: Boolean, links: Seq[Delays]): Boolean =
    lanesOf(pursuer, evader, shareEpisodes).isRight && refusals(shareEpisodes, links).isEmpty

  /** Why no lanes fly over links, for each link over which none do. */
  private def refusals(shareEpisodes: Boolean, links: Seq[Delays]): Seq[String] = (timing, model) match
    case (stream: LoopTiming.Stream, reduced: Reduced) if !shareEpisodes =>
      links.flatMap:
        case table: DelayTable => Option(StreamDuelKernel.refusal(stream, table.maxS, reduced))
        case _ => Some("worlds of their own fly by lanes where a link's delays do not come in stretches")
    case _ => Nil

  /** What flies by lanes over links that the lanes know, or why nothing does. */
  private def lanesOf(pursuer: Policy, evader: Policy, shareEpisodes: Boolean): Either[String, String] =
    plant.flatMap: _ =>
      val each    = LaneMath.LANES
      val refused = Seq(pursuer, evader).flatMap(PolicyLanes.of(_).left.toOption).headOption
      (timing, model) match
        case _ if shareEpisodes && refused.isEmpty && lanes.isRight =>
          Right(s"$each candidates of an episode at a time")
        case (_, _: QuadrotorResponse) =>
          Right(s"$each quadrotors at a time; their loops by the scalar engine")
        case _ if shareEpisodes && lanes.isLeft => Left(lanes.left.toOption.get)
        case _ if refused.isDefined             => Left(s"a policy is no formula: ${refused.get.getMessage}")
        case (_: LoopTiming.Stream, _: Reduced)
            if Seq(pursuer, evader).exists(PolicyLanes.get(_).needsAges) =>
          Left("a policy asks how old readings are, which the lanes tell only candidates that share episodes")
        case (_: LoopTiming.Stream, _: Reduced) => Right(s"$each worlds at a time")
        case (_: LoopTiming.Stream, _)          =>
          Left(
            "worlds with delays of their own fly by lanes with reduced, a model of three parameters, or quadrotor"
          )
        case _ =>
          Left("worlds with delays of their own fly by lanes under the stream loop, or with quadrotor")

  /** Flies all worlds, unless it is cancelled.
    *
    * @param onProgress
    *   is told how many worlds are done, after each batch, by one thread at a time
    * @param isCancelled
    *   asked before each batch, from any thread; batches that fly already end
    * @throws InterruptedException
    *   if the caller is interrupted; the batches that fly already have ended then
    */
  def fly(
      worlds: DuelWorlds,
      captureRadiusM: Double = 0.0,
      onProgress: Int => Unit = _ => (),
      isCancelled: () => Boolean = () => false
  ): DuelOutcomes =
    val outcomes = DuelOutcomes(worlds.size)
    val batches  =
      if worlds.shareEpisodes then
        WorldBatches.byEpisode(worlds.size, worlds.link, worlds.key, workers.head.together.batch)
      else WorldBatches.inOrder(worlds.size, workers.head.alone.batch)
    outcomes.flown = LaneThreads.run(workers, batches, isCancelled, onProgress): (worker, numbers) =>
      val flyer = if worlds.shareEpisodes then worker.together else worker.alone
      flyer.fly(worlds, numbers, captureRadiusM.toFloat, outcomes)
    outcomes

  /** Of some 200 kB for a minute each; a search flies the same few episodes again and again. */
  private inline val MostBytes = 64L << 20

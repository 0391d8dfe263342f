package skein.lanes

import java.util.concurrent.atomic.{AtomicInteger, AtomicReference}
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

  // A class with vectors is not touched where their module is missing.
  private val plant: Either[String, TimetableModel] =
    if ModuleLayer.boot().findModule("jdk.incubator.vector").isEmpty then
      Left("the module jdk.incubator.vector is missing; start Java with --add-modules jdk.incubator.vector")
    else TimetableModel.of(model, duel)

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

  private val timetables = Timetables(MostTimetables)
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
    val failure  = AtomicReference[Throwable]()
    val next     = AtomicInteger()
    val batches  =
      if worlds.shareEpisodes then WorldBatches.byEpisode(worlds, workers.head.together.batch)
      else WorldBatches.inOrder(worlds.size, workers.head.alone.batch)
    var done = 0

    def work(worker: Worker): Unit =
      val flyer = if worlds.shareEpisodes then worker.together else worker.alone
      var going = true
      while going do
        // Every batch that was handed out is flown.
        val number = if failure.get == null && !isCancelled() then next.getAndIncrement() else batches.count
        if number >= batches.count then going = false
        else
          val numbers = batches(number)
          flyer.fly(worlds, numbers, captureRadiusM.toFloat, outcomes)
          outcomes.synchronized:
            done += numbers.length
            onProgress(done)

    val flying = workers
      .take(batches.count)
      .map: worker =>
        val thread = Thread(() =>
          try work(worker)
          catch case thrown: Throwable => failure.compareAndSet(null, thrown): Unit
        )
        thread.setDaemon(true)
        thread.setName("skein-duels")
        thread
    flying.foreach(_.start())
    try flying.foreach(_.join())
    catch
      case interrupted: InterruptedException =>
        failure.compareAndSet(null, interrupted): Unit
        flying.foreach(_.join())
    if failure.get != null then throw failure.get
    outcomes.flown = done
    outcomes

  /** Of some 200 kB for a minute each; a search flies the same few episodes again and again. */
  private inline val MostTimetables = 256

/** Which worlds fly together. */
private final class WorldBatches(order: Array[Int], starts: Array[Int]):
  def count: Int = starts.length

  /** Numbers of the worlds. */
  def apply(batch: Int): Array[Int] =
    java.util.Arrays.copyOfRange(
      order,
      starts(batch),
      if batch + 1 < starts.length then starts(batch + 1) else order.length
    )

private object WorldBatches:
  def inOrder(worlds: Int, most: Int): WorldBatches =
    WorldBatches(Array.range(0, worlds), Array.range(0, worlds, most))

  /** A batch has worlds of one key and one link. */
  def byEpisode(worlds: DuelWorlds, most: Int): WorldBatches =
    val groups  = java.util.HashMap[(Delays, Int), Integer]()
    val groupOf = Array.tabulate(worlds.size): world =>
      groups.computeIfAbsent((worlds.link(world), worlds.key(world)), _ => groups.size).intValue
    val sizes = Array.ofDim[Int](groups.size)
    for group <- groupOf do sizes(group) += 1
    val ends  = sizes.scanLeft(0)(_ + _)
    val fill  = ends.clone
    val order = Array.ofDim[Int](worlds.size)
    for world <- groupOf.indices do
      order(fill(groupOf(world))) = world
      fill(groupOf(world)) += 1
    WorldBatches(order, sizes.indices.flatMap(group => ends(group) until ends(group + 1) by most).toArray)

package skein.rollout

import java.util.concurrent.atomic.{AtomicInteger, AtomicReference}
import skein.policy.{PaperEvader, PaperPursuer, Policy}

/** Flies many duels under one loop's timing, on all cores: the one front of forward simulation for searches and maps.
  *
  * The paper's policies under `LoopTiming.Stream` with a [[Reduced]] model fly by lanes ([[StreamDuelKernel]]), all else
  * by the scalar reference ([[Rollout]]). Which of the two flies a world depends on the world alone, so results do not
  * depend on threads, on a call's other worlds or on their order. One call at a time.
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

  /** Flies the worlds `from` until `until`, at most `batch` of them; one per thread. */
  private trait Flyer:
    def batch: Int
    def fly(worlds: DuelWorlds, from: Int, until: Int, captureRadiusM: Float, into: DuelOutcomes): Unit

  // The first flyer tells; a class with vectors is not touched where their module is missing.
  private val lanes: Either[String, (LoopTiming.Stream, Reduced)] =
    if ModuleLayer.boot().findModule("jdk.incubator.vector").isEmpty then
      Left("the module jdk.incubator.vector is missing; start Java with --add-modules jdk.incubator.vector")
    else
      (timing, model) match
        case (stream: LoopTiming.Stream, reduced: Reduced) if reduced.lagS > 0 => Right((stream, reduced))
        case (_: LoopTiming.Stream, _) => Left("the lanes fly only the reduced model with a lag")
        case _ => Left(s"the lanes fly only the stream loop, not ${timing.productPrefix}")

  private val flyers: Vector[Flyer] = Vector.fill(threads):
    lanes match
      case Right((stream, reduced)) => Lanes(stream, reduced)
      case Left(_)                  => Scalar()

  /** Which engine flies, and why, in a line for the user. Worlds of other policies than the paper's fly by the scalar
    * engine in any case.
    */
  val engine: String = lanes match
    case Right(_)     => s"SIMD, the paper's policies ${LaneMath.LANES} worlds at a time"
    case Left(reason) => s"scalar: $reason"

  /** Whether worlds of these policies fly by lanes. */
  def fliesByLanes(pursuer: Policy, evader: Policy): Boolean =
    lanes.isRight && DuelBatch.parameters(pursuer, evader).isDefined

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
    val batch    = flyers.head.batch
    val batches  = (worlds.size + batch - 1) / batch
    var done     = 0

    def work(flyer: Flyer): Unit =
      var going = true
      while going do
        // Batches are handed out in order, and every one that was handed out is flown.
        val number = if failure.get == null && !isCancelled() then next.getAndIncrement() else batches
        if number >= batches then going = false
        else
          val from  = number * batch
          val until = (from + batch).min(worlds.size)
          flyer.fly(worlds, from, until, captureRadiusM.toFloat, outcomes)
          outcomes.synchronized:
            done += until - from
            onProgress(done)

    val workers = flyers
      .take(batches)
      .map: flyer =>
        val worker = Thread(() =>
          try work(flyer)
          catch case thrown: Throwable => failure.compareAndSet(null, thrown): Unit
        )
        worker.setDaemon(true)
        worker.setName("skein-duels")
        worker
    workers.foreach(_.start())
    try workers.foreach(_.join())
    catch
      case interrupted: InterruptedException =>
        failure.compareAndSet(null, interrupted): Unit
        workers.foreach(_.join())
    if failure.get != null then throw failure.get
    outcomes.flown = done
    outcomes

  /** By the scalar reference. */
  private final class Scalar extends Flyer:
    val batch: Int                                 = 16
    private var last: (Policy, Policy, DelayTable) = (null, null, null)
    private var rollout: Rollout                   = null

    def fly(worlds: DuelWorlds, from: Int, until: Int, captureRadiusM: Float, into: DuelOutcomes): Unit =
      for world <- from until until do
        val wanted = (worlds.pursuer(world), worlds.evader(world), worlds.link(world))
        if wanted != last then
          last = wanted
          val (pursuer, evader, link) = wanted
          val own                     =
            Duel(duel.pursuer.copy(policy = pursuer), duel.evader.copy(policy = evader), duel.durationS)
          rollout = Rollout(own, timing, link, model)
        into.set(world, rollout.fly(worlds.key(world), captureRadiusM))

  /** By lanes, where a world's policies and link allow. */
  private final class Lanes(stream: LoopTiming.Stream, reduced: Reduced) extends Flyer:
    val batch: Int         = StreamDuelKernel.WORLDS
    private val kernel     = StreamDuelKernel(duel, stream, reduced)
    private val scalar     = Scalar()
    private val keys       = Array.ofDim[Int](batch)
    private val links      = Array.ofDim[DelayTable](batch)
    private val turnRates  = Array.ofDim[Float](batch)
    private val radii      = Array.ofDim[Float](batch)
    private val laneWorlds = Array.ofDim[Int](batch)

    def fly(worlds: DuelWorlds, from: Int, until: Int, captureRadiusM: Float, into: DuelOutcomes): Unit =
      var filled = 0
      for world <- from until until do
        val link = worlds.link(world)
        DuelBatch.parameters(worlds.pursuer(world), worlds.evader(world)) match
          case Some((turnRate, radius)) if StreamDuelKernel.canFly(stream, link, reduced) =>
            laneWorlds(filled) = world
            keys(filled) = worlds.key(world)
            links(filled) = link
            turnRates(filled) = turnRate
            radii(filled) = radius
            filled += 1
          case _ => scalar.fly(worlds, world, world + 1, captureRadiusM, into)
      if filled > 0 then
        // Lanes that no world needs fly the last one again.
        for lane <- filled until batch do
          keys(lane) = keys(filled - 1)
          links(lane) = links(filled - 1)
          turnRates(lane) = turnRates(filled - 1)
          radii(lane) = radii(filled - 1)
        kernel.fly(keys, links, turnRates, radii, captureRadiusM)
        for lane <- 0 until filled do
          val world = laneWorlds(lane)
          into.minDistanceM(world) = kernel.minDistance(lane)
          into.meanDistanceM(world) = kernel.meanDistance(lane)
          into.meanLast10sM(world) = kernel.meanLast10s(lane)
          into.captureS(world) = kernel.captureS(lane)
          into.pursuerEffortRad(world) = kernel.pursuerEffortRad(lane)
          into.evaderEffortRad(world) = kernel.evaderEffortRad(lane)

object DuelBatch:
  /** Turn rate, rad/s, and radius, m, where these are the policies that the kernel knows. */
  private def parameters(pursuer: Policy, evader: Policy): Option[(Float, Float)] =
    (pursuer, evader) match
      case (PaperPursuer(turnRate, None), PaperEvader(radius)) => Some((turnRate.toFloat, radius.toFloat))
      case _                                                   => None

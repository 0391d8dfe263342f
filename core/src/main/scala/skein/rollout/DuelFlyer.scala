package skein.rollout

import skein.policy.{PaperEvader, PaperPursuer, Policy}

/** Flies a batch of worlds on one thread. Mutable. */
private trait DuelFlyer:
  /** Most worlds of a batch. */
  def batch: Int

  def fly(worlds: DuelWorlds, numbers: Array[Int], captureRadiusM: Float, into: DuelOutcomes): Unit

/** The policies that the kernels know: turn rate, rad/s, turn per decision, rad, and the evader's radius, m. */
private final case class PaperParameters(turnRate: Float, turnStep: Float, radius: Float)

private object PaperParameters:
  def of(pursuer: Policy, evader: Policy): Option[PaperParameters] =
    (pursuer, evader) match
      case (PaperPursuer(turnRate, None), PaperEvader(radius)) =>
        Some(PaperParameters(turnRate.toFloat, 0, radius.toFloat))
      case (PaperPursuer(_, Some(step)), PaperEvader(radius)) =>
        Some(PaperParameters(0, step.toFloat, radius.toFloat))
      case _ => None

/** By the scalar reference. */
private final class ScalarFlyer(duel: Duel, timing: LoopTiming, model: VelocityResponse) extends DuelFlyer:
  val batch: Int                             = 16
  private var last: (Policy, Policy, Delays) = (null, null, null)
  private var rollout: Rollout               = null

  def fly(worlds: DuelWorlds, numbers: Array[Int], captureRadiusM: Float, into: DuelOutcomes): Unit =
    for world <- numbers do
      val wanted = (worlds.pursuer(world), worlds.evader(world), worlds.link(world))
      if wanted != last then
        last = wanted
        val (pursuer, evader, link) = wanted
        val own = Duel(duel.pursuer.copy(policy = pursuer), duel.evader.copy(policy = evader), duel.durationS)
        rollout = Rollout(own, timing, link, model)
      into.set(world, rollout.fly(worlds.key(world), captureRadiusM))

/** By [[StreamDuelKernel]], where a world's policies and link allow. */
private final class StreamFlyer(duel: Duel, timing: LoopTiming.Stream, model: Reduced, scalar: DuelFlyer)
    extends DuelFlyer:
  val batch: Int = StreamDuelKernel.WORLDS

  /** Worlds of one form of pursuer and one of evader. */
  private final class Group(pursuerPolicy: Policy, evaderPolicy: Policy):
    private val pursuers = LanePolicy.of(pursuerPolicy)
    private val evaders  = LanePolicy.of(evaderPolicy)
    private val kernel   = StreamDuelKernel(duel, timing, model, pursuers, evaders, true)
    private val keys     = Array.ofDim[Int](batch)
    private val links    = Array.ofDim[DelayTable](batch)
    private val ofLane   = Array.ofDim[Int](batch)
    private var filled   = 0

    def add(worlds: DuelWorlds, world: Int, link: DelayTable): Unit =
      ofLane(filled) = world
      keys(filled) = worlds.key(world)
      links(filled) = link
      pursuers.take(filled, worlds.pursuer(world))
      evaders.take(filled, worlds.evader(world))
      filled += 1

    def fly(worlds: DuelWorlds, captureRadiusM: Float, into: DuelOutcomes): Unit =
      val last = ofLane(filled - 1)
      // Lanes that no world needs fly the last one again.
      for lane <- filled until batch do
        keys(lane) = keys(filled - 1)
        links(lane) = links(filled - 1)
        pursuers.take(lane, worlds.pursuer(last))
        evaders.take(lane, worlds.evader(last))
      kernel.fly(keys, links, captureRadiusM)
      for lane <- 0 until filled do
        val world = ofLane(lane)
        into.minDistanceM(world) = kernel.minDistance(lane)
        into.meanDistanceM(world) = kernel.meanDistance(lane)
        into.meanLast10sM(world) = kernel.meanLast10s(lane)
        into.captureS(world) = kernel.captureS(lane)
        into.pursuerEffortRad(world) = kernel.pursuerEffortRad(lane)
        into.evaderEffortRad(world) = kernel.evaderEffortRad(lane)
      filled = 0

  private val groups = collection.mutable.LinkedHashMap.empty[(AnyRef, AnyRef), Group]

  def fly(worlds: DuelWorlds, numbers: Array[Int], captureRadiusM: Float, into: DuelOutcomes): Unit =
    val filled = collection.mutable.LinkedHashSet.empty[Group]
    for world <- numbers do
      val (pursuer, evader) = (worlds.pursuer(world), worlds.evader(world))
      val forms             = (LanePolicy.formOf(pursuer), LanePolicy.formOf(evader))
      worlds.link(world) match
        case table: DelayTable
            if forms._1 != null && forms._2 != null && StreamDuelKernel.canFly(timing, table, model) =>
          val group = groups.getOrElseUpdate(forms, Group(pursuer, evader))
          group.add(worlds, world, table)
          filled += group
        case _ => scalar.fly(worlds, Array(world), captureRadiusM, into)
    for group <- filled do group.fly(worlds, captureRadiusM, into)

/** By [[TimetableKernel]], where a world's policies allow. All worlds of a batch have one key and one link. */
private final class TimetableFlyer(
    duel: Duel,
    timing: LoopTiming,
    model: Reduced,
    timetables: Timetables,
    scalar: DuelFlyer
) extends DuelFlyer:
  val batch: Int        = TimetableKernel.WORLDS
  private val kernel    = TimetableKernel(duel, timing, model)
  private val turnRates = Array.ofDim[Float](batch)
  private val turnSteps = Array.ofDim[Float](batch)
  private val radii     = Array.ofDim[Float](batch)
  private val ofLane    = Array.ofDim[Int](batch)

  def fly(worlds: DuelWorlds, numbers: Array[Int], captureRadiusM: Float, into: DuelOutcomes): Unit =
    var filled = 0
    for world <- numbers do
      PaperParameters.of(worlds.pursuer(world), worlds.evader(world)) match
        case Some(parameters) =>
          ofLane(filled) = world
          turnRates(filled) = parameters.turnRate
          turnSteps(filled) = parameters.turnStep
          radii(filled) = parameters.radius
          filled += 1
        case None => scalar.fly(worlds, Array(world), captureRadiusM, into)
    if filled > 0 then
      for lane <- filled until batch do
        turnRates(lane) = turnRates(filled - 1)
        turnSteps(lane) = turnSteps(filled - 1)
        radii(lane) = radii(filled - 1)
      val (link, key) = (worlds.link(numbers.head), worlds.key(numbers.head))
      val timetable = timetables.getOrMake(link, key)(Timetable.of(duel.durationS, timing, link, key, model))
      kernel.fly(timetable, turnRates, turnSteps, radii, captureRadiusM)
      for lane <- 0 until filled do
        val world = ofLane(lane)
        into.minDistanceM(world) = kernel.minDistance(lane)
        into.meanDistanceM(world) = kernel.meanDistance(lane)
        into.meanLast10sM(world) = kernel.meanLast10s(lane)
        into.captureS(world) = kernel.captureS(lane)
        into.pursuerEffortRad(world) = kernel.pursuerEffortRad(lane)
        into.evaderEffortRad(world) = kernel.evaderEffortRad(lane)

/** The timetables used last, for all threads. */
private final class Timetables(most: Int):
  private val known = new java.util.LinkedHashMap[(Delays, Int), Timetable](16, 0.75f, true):
    override def removeEldestEntry(eldest: java.util.Map.Entry[(Delays, Int), Timetable]): Boolean =
      size > most

  /** Two threads may make the same at once; they make it equal. */
  def getOrMake(link: Delays, key: Int)(make: => Timetable): Timetable =
    val held = known.synchronized(known.get((link, key)))
    if held != null then held
    else
      val made = make
      known.synchronized(known.put((link, key), made)): Unit
      made

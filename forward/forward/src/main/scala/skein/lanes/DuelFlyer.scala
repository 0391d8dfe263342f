package skein.lanes

import skein.formula.Untraceable
import skein.forward.{Delays, Duel, LoopTiming, Rollout, TabledDelays, VelocityResponse}
import skein.lanes.loop.{BySlowest, LoopLanes}
import skein.lanes.policy.{LanePolicy, PolicyLanes}
import skein.lanes.timetable.{Timetable, TimetableEye, Timetables}
import skein.policy.HeadingPolicy

/** Simulates a batch of worlds on one thread. Mutable. */
private trait DuelFlyer:
  def batch: Int

  def fly(worlds: DuelWorlds, numbers: Array[Int], captureRadiusM: Float, into: DuelOutcomes): Unit

/** Simulates the worlds of a batch one by one, by the scalar reference. */
private final class ScalarFlyer(duel: Duel, timing: LoopTiming, model: VelocityResponse) extends DuelFlyer:
  val batch: Int      = 16
  private val rollout = KeptRollout(duel, timing, model)

  def fly(worlds: DuelWorlds, numbers: Array[Int], captureRadiusM: Float, into: DuelOutcomes): Unit =
    for world <- numbers do
      into.set(world, rollout(worlds, world).fly(worlds.key(world), captureRadiusM))

/** The rollout of the last world, reused for the next one if its policies and link are equal. Mutable. */
private final class KeptRollout(duel: Duel, timing: LoopTiming, model: => VelocityResponse):
  private var last: (HeadingPolicy, HeadingPolicy, Delays) = (null, null, null)
  private var rollout: Rollout                             = null

  def apply(worlds: DuelWorlds, world: Int): Rollout =
    val wanted = (worlds.pursuer(world), worlds.evader(world), worlds.link(world))
    if wanted != last then
      last = wanted
      val (pursuer, evader, link) = wanted
      val own = duel.copy(duel.pursuer.copy(policy = pursuer), duel.evader.copy(policy = evader))
      rollout = Rollout(own, timing, link, model)
    rollout

/** Simulates vehicles side by side by SIMD, and their loops by the scalar reference. */
private final class SteppedFlyer(duel: Duel, timing: LoopTiming, stepped: SteppedRollouts) extends DuelFlyer:
  val batch: Int   = stepped.worlds
  private val kept = Array.tabulate(batch)(lane => KeptRollout(duel, timing, stepped.vehiclesOf(lane)))

  def fly(worlds: DuelWorlds, numbers: Array[Int], captureRadiusM: Float, into: DuelOutcomes): Unit =
    for some <- numbers.grouped(batch) do
      val rollouts = some.indices.map(lane => kept(lane)(worlds, some(lane)))
      stepped.fly(some.length): lane =>
        rollouts(lane).start(worlds.key(some(lane)), captureRadiusM)
        rollouts(lane)
      for lane <- some.indices do into.set(some(lane), rollouts(lane).outcome)

/** Simulates a batch by SIMD: worlds with one form of pursuer and one of evader run side by side. Worlds that
  * SIMD does not support go to another flyer.
  */
private abstract class LaneFlyer(other: DuelFlyer) extends DuelFlyer:
  val batch: Int = DuelKernel.WORLDS

  /** A kernel with its policies, and the worlds assigned to its lanes. */
  protected abstract class Lanes(pursuer: HeadingPolicy, evader: HeadingPolicy, asked: Set[DuelNumber]):
    protected val pursuers: LanePolicy = LanePolicy.of(pursuer, asked(DuelNumber.PursuerEffort))
    protected val evaders: LanePolicy  = LanePolicy.of(evader, asked(DuelNumber.EvaderEffort))
    private val ofLane                 = Array.ofDim[Int](batch)
    private var filled                 = 0

    // Who flies in the lane filled last.
    private var lastPursuer, lastEvader: HeadingPolicy = null

    protected def kernel: DuelKernel

    protected def count: Int = filled

    protected def fly(captureRadiusM: Float): Unit

    protected def fill(lane: Int, worlds: DuelWorlds, world: Int): Unit

    def add(worlds: DuelWorlds, world: Int): Unit =
      ofLane(filled) = world
      put(filled, worlds, world)
      filled += 1

    private def put(lane: Int, worlds: DuelWorlds, world: Int): Unit =
      val (pursuer, evader) = (worlds.pursuer(world), worlds.evader(world))
      put(lane, pursuers, pursuer, lastPursuer)
      put(lane, evaders, evader, lastEvader)
      lastPursuer = pursuer
      lastEvader = evader
      fill(lane, worlds, world)

    /** Reads a policy's numbers, unless the lane before was filled with an identical policy. */
    private def put(lane: Int, lanes: LanePolicy, policy: HeadingPolicy, before: HeadingPolicy): Unit =
      if lane > 0 && (policy eq before) then lanes.copy(lane - 1, lane) else lanes.put(lane, policy)

    def fly(worlds: DuelWorlds, captureRadiusM: Float, into: DuelOutcomes): Unit =
      // Lanes that no world needs fly the last one again.
      for lane <- filled until batch do put(lane, worlds, ofLane(filled - 1))
      fly(captureRadiusM)
      kernel.tell(ofLane, filled, into)
      filled = 0

  protected def lanes(pursuer: HeadingPolicy, evader: HeadingPolicy, asked: Set[DuelNumber]): Lanes

  protected def canFly(link: Delays): Boolean

  private type Form = Either[Untraceable, PolicyLanes]

  private val byForm = collection.mutable.HashMap.empty[(Form, Form, Set[DuelNumber]), Lanes]

  def fly(worlds: DuelWorlds, numbers: Array[Int], captureRadiusM: Float, into: DuelOutcomes): Unit =
    val filled  = collection.mutable.LinkedHashSet.empty[Lanes]
    val unknown = Array.newBuilder[Int]

    // Neighbours often fly the very same policy.
    var (lastPursuer, lastEvader) = (null: HeadingPolicy, null: HeadingPolicy)
    var forms                     = (null: Form, null: Form)
    for world <- numbers do
      val (pursuer, evader) = (worlds.pursuer(world), worlds.evader(world))
      if (pursuer ne lastPursuer) || (evader ne lastEvader) then
        forms = (
          if pursuer eq lastPursuer then forms._1 else PolicyLanes.of(pursuer),
          if evader eq lastEvader then forms._2 else PolicyLanes.of(evader)
        )
        lastPursuer = pursuer
        lastEvader = evader
      if forms._1.isRight && forms._2.isRight && canFly(worlds.link(world)) then
        val chosen =
          byForm.getOrElseUpdate(
            (forms._1, forms._2, worlds.asked),
            lanes(pursuer, evader, worlds.asked)
          )
        chosen.add(worlds, world)
        filled += chosen
      else unknown += world
    other.fly(worlds, unknown.result(), captureRadiusM, into)
    for chosen <- filled do chosen.fly(worlds, captureRadiusM, into)

/** Simulates by [[LoopDuelKernel]], where a world's link allows. */
private final class LoopFlyer(
    duel: Duel,
    timing: LoopTiming,
    model: LaneDynamics,
    eyes: DuelEyes,
    other: DuelFlyer
) extends LaneFlyer(other):

  protected def canFly(link: Delays): Boolean = LoopSupport.refusal(timing, 2, link, model).isEmpty

  protected def lanes(pursuer: HeadingPolicy, evader: HeadingPolicy, asked: Set[DuelNumber]): Lanes =
    new Lanes(pursuer, evader, asked):
      private val keys    = Array.ofDim[Int](batch)
      private val links   = Array.ofDim[TabledDelays](batch)
      private val kernels = BySlowest: maxDelayS =>
        val loop = LoopLanes(timing, 2, duel.durationS, maxDelayS, sees = !eyes.isNobody)
        LoopDuelKernel(duel, loop, model, pursuers, evaders, asked, eyes)

      protected def kernel: LoopDuelKernel = kernels(links)

      protected def fill(lane: Int, worlds: DuelWorlds, world: Int): Unit =
        keys(lane) = worlds.key(world)
        links(lane) = worlds.link(world).asInstanceOf[TabledDelays]

      protected def fly(captureRadiusM: Float): Unit = kernel.fly(keys, links, captureRadiusM)

/** Simulates by [[skein.lanes.timetable.TimetableKernel]]. All worlds of a batch have one key and one link,
  * or no delays.
  */
private final class TimetableFlyer(episodes: DuelEpisodes, timetables: Timetables, other: DuelFlyer)
    extends LaneFlyer(other):
  import episodes.{duel, eyes}

  protected def canFly(link: Delays): Boolean = true

  protected def lanes(pursuer: HeadingPolicy, evader: HeadingPolicy, asked: Set[DuelNumber]): Lanes =
    new Lanes(pursuer, evader, asked):
      protected val kernel: TimetableDuels = TimetableDuels(
        duel,
        episodes.timing,
        episodes.model,
        pursuers,
        evaders,
        asked,
        eyes.pursuer.map(TimetableEye(_, duel.pursuer, duel.evader)).orNull,
        eyes.evader.map(TimetableEye(_, duel.evader, duel.pursuer)).orNull
      )
      private var timetable: Timetable = null

      protected def fill(lane: Int, worlds: DuelWorlds, world: Int): Unit =
        if lane == 0 then
          val (link, key) = (worlds.link(world), worlds.key(world))
          timetable = timetables.getOrMake(episodes.of(link, key))(episodes.timetable(link, key))

      protected def fly(captureRadiusM: Float): Unit = kernel.fly(timetable, count, captureRadiusM)

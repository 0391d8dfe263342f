package skein.lanes

import scala.collection.mutable.ArrayBuffer
import skein.forward.*
import skein.fusion.Exposure
import skein.lanes.loop.LoopEye
import skein.lanes.policy.{LaneObservation, PolicyLanes}
import skein.policy.{Action, Observation, PlanarObservation, Policy}

/** Compares SIMD duels with the scalar engine, decision by decision, by [[Agreement]]. All but the vehicles'
  * motion is compared to the bit: a decision starts from the heading and memory of the SIMD engine's previous
  * one, and the opponent's heading is that of the decision which the scalar engine knows.
  *
  * @param lanes the SIMD engine's policies, by agent, the evader first
  * @param policies the policies of one world, indexed by agent
  */
private[skein] class PairAgreement(
    duel: Pair,
    timing: LoopTiming,
    model: VelocityResponse,
    link: Int => Delays,
    key: Int => Int,
    captureM: Float,
    policies: Vector[Int => Policy],
    lanes: Vector[LoggedPolicy],
    val flown: PairKernel
):
  import PairAgreement.*

  def check(what: String, worlds: Seq[Int], atLeast: Int = 1)(using munit.Location): Unit =
    val agreement = Agreement()
    for world <- worlds do
      val logs    = policies.map(of => Log(of(world)))
      val scalar  = duel.copy(duel.pursuer.copy(policy = logs(1)), duel.evader.copy(policy = logs(0)))
      val events  = Events(scalar.engagement, timing, captureM)
      val rollout = Rollout(scalar.engagement, timing, link(world), model)
      rollout.fly(key(world), events)
      val came = events.outcome(rollout)
      // The errors of directions so far, each within its bound.
      var off   = 0.0
      val first = events.all.iterator
        .flatMap:
          case looked: Event.Looked   => difference(looked, world)
          case decided: Event.Decided =>
            val departs = difference(decided, logs(decided.agent), world, placesOff(decided.timeS, off))
            off = off.max(directionOff(decided, logs(decided.agent), world))
            departs
        .nextOption()
      agreement.add(world, first)(outcomes(world, came, events.distances.toVector, placesOff(_, off)))
    agreement.check(what, atLeast)

  /** The difference of an image that a world's scalar engine took, if any. */
  protected def difference(looked: Event.Looked, world: Int): Option[Agreement.Departure] = None

  /** Bound on the vehicles' error, m and m/s: by rounding, and by their speeds times the error of directions.
    */
  private def placesOff(timeS: Double, direction: Double) =
    Agreement.mostOff(timeS) + direction * (duel.pursuer.speed + duel.evader.speed) * timeS.max(1)

  private def directionOff(event: Event.Decided, log: Log, world: Int): Double =
    val ours    = lanes(event.agent).made(lanes(event.agent).number(world, event.k))
    val heading = log.decided(event.k)
    math.hypot(
      ours.outputs(0)(world) - StrictMath.cos(heading),
      ours.outputs(1)(world) - StrictMath.sin(heading)
    )

  private def difference(
      event: Event.Decided,
      log: Log,
      world: Int,
      placesOff: Double
  ): Option[Agreement.Departure] =
    import event.{agent, k, timeS}
    def where  = s"world $world, agent $agent, decision $k, at $timeS s"
    val form   = PolicyLanes.get(policies(agent)(world))
    val number = lanes(agent).number(world, k)
    must(number >= 0, s"$where: lanes decided only ${lanes(agent).count(world)} times")
    val ours   = lanes(agent).made(number)
    val inputs = inputsOf(log.seen(k), log.before(k), ours, world)
    val off    = ours.off(inputs, world)
    for i <- 0 until LaneObservation.READ if i < 2 || form.needsVelocity do
      must(off(i) < placesOff, s"$where: ${off(i)} off in reading $i")
    for i <- Seq(PolicyLanes.In.Elapsed) ++
        Option.when(form.needsAges)(Seq(PolicyLanes.In.OwnAge, PolicyLanes.In.OpponentAge)).toSeq.flatten
    do must(off(i) <= TimeOff * (1 + inputs(i)), s"$where: ${off(i)} s off in time $i of ${inputs(i)} s")
    if k > 0 then
      val before = lanes(agent).made(lanes(agent).number(world, k - 1))
      for (input, output) <- carried(form) do
        must(
          ours.inputs(input)(world) == before.outputs(output)(world),
          s"$where: input $input is not what was decided before"
        )
    else
      for (input, _) <- carried(form) do
        must(
          off(input) <= AtFirst * (1 + math.abs(inputs(input))),
          s"$where: ${off(input)} off in input $input"
        )
    if duel.pursuer.eye.isEmpty && duel.evader.eye.isEmpty && event.known > 0 then
      val other = lanes(1 - agent)
      val known = other.made(other.number(world, event.known - 1))
      for i <- 0 until 2 do
        must(
          ours.inputs(PolicyLanes.In.KnownCos + i)(world) == known.outputs(i)(world),
          s"$where: not the opponent's decision ${event.known - 1}"
        )
    departure(agent, k, timeS, policies(agent)(world), log.seen(k), log.before(k), ours, world)

  /** Where decisions are equal, the flights must be equal. */
  private def outcomes(
      world: Int,
      came: EpisodeOutcome,
      distances: Vector[(Double, Double)],
      placesOff: Double => Double
  ): Unit =
    def same(what: String, ours: Double, scalar: Double) =
      must(math.abs(ours - scalar) < placesOff(duel.durationS), s"world $world: $what $ours, scalar $scalar")
    same("least distance", flown(PairNumber.MinDistance)(world), came.minDistanceM)
    same("mean distance", flown(PairNumber.MeanDistance)(world), came.meanDistanceM)
    same("mean of the last 10 s", flown(PairNumber.MeanLast10s)(world), came.meanLast10sM)
    same("pursuer's effort", flown(PairNumber.PursuerEffort)(world), came.pursuerEffortRad)
    same("evader's effort", flown(PairNumber.EvaderEffort)(world), came.evaderEffortRad)
    // One engine captures a period before the other if that period's distance differs from the limit by less
    // than the error of distances.
    val sooner = math.min(flown(PairNumber.Capture)(world), came.captureS)
    must(
      flown(PairNumber.Capture)(world) == came.captureS.toFloat ||
        distances.exists((timeS, m) =>
          math.abs(timeS - sooner) < 1e-3 && math.abs(m - captureM) < math.sqrt(2) * placesOff(timeS)
        ),
      s"world $world: captured after ${flown(PairNumber.Capture)(world)} s, scalar ${came.captureS} s; " +
        s"nearest to the radius: ${distances.minByOption((_, m) => math.abs(m - captureM))}"
    )

private[skein] object PairAgreement:
  private val Heading = PolicyLanes.In.Heading

  /** Rounding of a time, as a fraction of a second; grains of 4 ns are exact. */
  private val TimeOff = 2e-7

  /** The value of a number that is not computed. */
  private val AtFirst = 1e-6

  /** The decision of a policy in doubles, by its form. */
  private def inputsOf(
      seen: PlanarObservation,
      memory: Any,
      ours: LoggedPolicy.Made,
      world: Int
  ): Array[Double] =
    val inputs = LanePolicies.inputsOf(seen, memory)
    // Angles a turn apart are one.
    inputs(
      Heading
    ) += 2 * math.Pi * math.rint((ours.inputs(Heading)(world) - inputs(Heading)) / (2 * math.Pi))
    inputs

  /** The SIMD engine's decisions in a world, compared with the policy's in doubles. */
  def departure(
      agent: Int,
      k: Int,
      timeS: Double,
      policy: Policy,
      seen: PlanarObservation,
      memory: Any,
      ours: LoggedPolicy.Made,
      world: Int
  ): Option[Agreement.Departure] =
    val form    = PolicyLanes.get(policy)
    val inputs  = inputsOf(seen, memory, ours, world)
    val turning = form.keepsHeading
    Agreement.departure(
      agent,
      k,
      timeS,
      form.outputs,
      inputs,
      ours.off(inputs, world),
      form.parametersOf(policy),
      ours.outputs.map(_(world).toDouble),
      (i, a, b) =>
        if turning && i == form.outputs.size - 1 then math.abs(math.IEEEremainder(a - b, 2 * math.Pi))
        else math.abs(a - b)
    )

  /** Inputs that are outputs of the decision before. */
  private def carried(form: PolicyLanes): Seq[(Int, Int)] =
    Seq(PolicyLanes.In.OwnCos -> 0, PolicyLanes.In.OwnSin -> 1) ++
      Seq.tabulate(form.memories)(i => (PolicyLanes.In.Memory + i, 3 + i)) ++
      Option.when(form.keepsHeading)(Heading -> (form.outputs.size - 1))

  private def must(holds: Boolean, clue: => String): Unit = if !holds then throw AssertionError(clue)

  /** Candidates that meet one episode, by [[skein.lanes.timetable.TimetableKernel]]. */
  def shared(
      duel: Pair,
      timing: LoopTiming,
      model: VelocityResponse,
      link: Delays,
      key: Int,
      captureM: Float = 0
  )(pursuer: Int => Policy, evader: Int => Policy): PairAgreement =
    val lanes  = taken(pursuer, evader)
    val kernel = PairKernels.shared(duel, timing, model, lanes, link, key, captureM)
    PairAgreement(duel, timing, model, _ => link, _ => key, captureM, Vector(evader, pursuer), lanes, kernel)

  /** Worlds with delays of their own, by [[skein.lanes.loop.LoopKernel]]. */
  def alone(
      duel: Pair,
      timing: LoopTiming,
      model: VelocityResponse,
      link: Int => TabledDelays,
      key: Int => Int,
      captureM: Float = 0
  )(pursuer: Int => Policy, evader: Int => Policy): PairAgreement =
    val lanes  = taken(pursuer, evader)
    val kernel = flownAlone(duel, timing, model, link, key, captureM, lanes)
    PairAgreement(duel, timing, model, link, key, captureM, Vector(evader, pursuer), lanes, kernel)

  /** The kernel after its simulation.
    *
    * @param lanes the evader's and the pursuer's policies
    */
  def flownAlone(
      duel: Pair,
      timing: LoopTiming,
      model: VelocityResponse,
      link: Int => TabledDelays,
      key: Int => Int,
      captureM: Float,
      lanes: Vector[LoggedPolicy],
      newEye: Opponents.NewEye = LoopEye(_, _, _, _, _, _)
  ): PairKernel =
    val worlds = Array.range(0, PairKernels.WORLDS)
    PairKernels.alone(duel, timing, model, lanes, worlds.map(link), worlds.map(key), captureM, newEye)

  /** The SIMD policies of these, the evader's first. */
  def taken(pursuer: Int => Policy, evader: Int => Policy): Vector[LoggedPolicy] =
    Vector(evader, pursuer).map: of =>
      val lanes = LoggedPolicy(of(0))
      for world <- 0 until PairKernels.WORLDS do LanePolicies.take(lanes)(world, of(world))
      lanes

  enum Event:
    /** @param k counts the agent's decisions from 0
      * @param known the newest decision of the opponent that is known, from 1; 0 before the first
      */
    case Decided(agent: Int, k: Int, timeS: Double, known: Int)
    case Looked(k: Int, timeS: Double, exposure: Exposure)

  /** The scalar engine's decisions and observations in order; and the distance of the two vehicles, once a
    * period.
    */
  final class Events(of: Engagement, timing: LoopTiming, captureM: Double)
      extends Scoring(of, timing, captureM):
    val all: ArrayBuffer[Event]                  = ArrayBuffer.empty
    val distances: ArrayBuffer[(Double, Double)] = ArrayBuffer.empty
    private val decisions                        = Array(0, 0)
    private var looks                            = 0
    private var (x0, y0)                         = (0.0, 0.0)

    override def decided(vehicle: Int, atNs: Long, elapsedS: Double, upon: Grounds): Unit =
      all += Event.Decided(vehicle, decisions(vehicle), atNs * 1e-9, upon.sentDecision(1 - vehicle))
      decisions(vehicle) += 1

    override def exposed(vehicle: Int, number: Int, atNs: Long, image: Exposure): Unit =
      all += Event.Looked(looks, atNs * 1e-9, image)
      looks += 1

    override def scored(timeS: Double, vehicle: Int, x: Double, y: Double, z: Double): Unit =
      super.scored(timeS, vehicle, x, y, z)
      if vehicle == 0 then
        x0 = x; y0 = y
      else distances += timeS -> math.hypot(x - x0, y - y0)

  /** Records a policy's observations, and decides as it does. */
  final class Log(val policy: Policy) extends Policy:
    type Memory = policy.Memory
    val seen: ArrayBuffer[PlanarObservation] = ArrayBuffer.empty
    val before: ArrayBuffer[Any]             = ArrayBuffer.empty
    val decided: ArrayBuffer[Double]         = ArrayBuffer.empty
    def start: Memory                        =
      seen.clear()
      before.clear()
      decided.clear()
      policy.start
    def choose(observed: Observation, memory: Memory): (Action, Memory) =
      seen += PlanarObservation.of(observed)
      before += memory
      val answer = policy.choose(observed, memory)
      decided += answer._1.headingRad(observed.headingRad)
      answer

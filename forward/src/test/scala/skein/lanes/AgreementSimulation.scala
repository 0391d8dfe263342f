package skein.lanes

import scala.collection.mutable.ArrayBuffer
import skein.forward.{DelayTable, Duel, LoopTiming, Reduced, Rollout}
import skein.formula.{ErrorBound, Node}
import skein.policy.*
import skein.signal.SplitMix64
import skein.simd.WorldRandom

/** Lanes and the scalar engine take the same decisions in every world, but where a number that a policy compares lies so
  * near to another that rounding decides: that is told, with how near it was, by [[ErrorBound]].
  */
class AgreementSimulation extends munit.FunSuite:
  import AgreementSimulation.*

  private val model  = Reduced(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)
  private val worlds = DuelKernel.WORLDS

  /** The paper's, but that the evader does not start straight ahead, on a threshold of most pursuers. */
  private val duel = Duel.paper.copy(evader = Duel.paper.evader.copy(startY = 2), durationS = 10)

  private def drawn(family: PolicyFamily)(random: SplitMix64): Policy =
    family.policy(family.space.at(Vector.fill(family.space.dimension)(random.nextDouble())))

  private val pursuers: Seq[(String, SplitMix64 => Policy)] =
    PolicyFamily.all.filter(_.roles(Role.Pursuer)).map(family =>
      family.name -> drawn(family)
    ) ++ UnseenPolicySuite.Unseen
  private val evaders: Seq[(String, SplitMix64 => Policy)] = Seq(
    "paper-evader"     -> drawn(PolicyFamily.paperEvader),
    "chauffeur-evader" -> drawn(PolicyFamily.chauffeurEvader)
  )

  for
    (pursuer, drawPursuer) <- pursuers
    (evader, drawEvader)   <- evaders
    timing                 <-
      Seq(LoopTiming.Stream(), LoopTiming.Sequential(), LoopTiming.Predictive(predictor = model.predictor))
  do
    test(s"$pursuer against $evader, ${timing.productPrefix}: the same decisions in each world compared"):
      val seed     = 19L
      val random   = SplitMix64(seed)
      val hunters  = Vector.fill(worlds)(drawPursuer(random))
      val fleeing  = Vector.fill(worlds)(drawEvader(random))
      val key      = WorldRandom.key(2, 0, 0)
      val vehicles = LaneDynamics.under(timing, model, duel).fold(fail(_), identity)
      val lanes    = Vector(Logged(fleeing(0)), Logged(hunters(0)))
      for world <- 0 until worlds do
        lanes(0).take(world, fleeing(world))
        lanes(1).take(world, hunters(world))
      TimetableDuels(duel, timing, vehicles, lanes(1), lanes(0))
        .fly(Timetable.of(2, duel.durationS, timing, DelayTable.vpn, key, vehicles), worlds, 0)
      var same, parted = 0
      // Of every place within a vector some.
      for world <- 0 until worlds by 7 do
        val logs   = Vector(Log(fleeing(world)), Log(hunters(world)))
        val scalar =
          Duel(duel.pursuer.copy(policy = logs(1)), duel.evader.copy(policy = logs(0)), duel.durationS)
        Rollout(scalar, timing, DelayTable.vpn, model).fly(key): Unit
        first(logs, lanes, world, Vector(fleeing(world), hunters(world))) match
          case None                                       => same += 1
          case Some(difference) if difference.isUndecided => parted += 1
          case Some(difference)                           => fail(s"seed $seed, world $world: $difference")
      assert(same > 0, s"in all $parted worlds rounding decided sooner or later")

  /** The first decision of a world, of either agent, that differs by more than the bound. */
  private def first(
      scalar: Vector[Log],
      lanes: Vector[Logged],
      world: Int,
      policies: Vector[Policy]
  ): Option[Difference] =
    val order =
      for
        agent <- Vector(0, 1)
        k     <- 0 until math.min(scalar(agent).seen.size, lanes(agent).made.size)
      yield (agent, k)
    // Of both agents, by how far into the flight it is.
    val share = order.sortBy((agent, k) => k.toDouble / scalar(agent).seen.size)
    share.iterator
      .flatMap((agent, k) => difference(agent, k, policies(agent), scalar(agent), lanes(agent), world))
      .nextOption()

object AgreementSimulation:
  /** Of what floats add up to in the vehicles' flight. */
  private val MostOffM = 5e-3

  final case class Difference(
      agent: Int,
      decision: Int,
      apart: Vector[(Double, Double)],
      asDoubles: Vector[(Double, Double)],
      near: Vector[(Node, Double)]
  ):
    /** A threshold is so near that rounding may decide, and the decision is off by no more than both ways allow. */
    def isUndecided: Boolean = near.nonEmpty && apart.forall((by, most) => by <= most)

  /** A decision of an agent in a world, where it differs by more than the bound of the way that doubles take. */
  def difference(
      agent: Int,
      k: Int,
      policy: Policy,
      scalar: Log,
      lanes: Logged,
      world: Int
  ): Option[Difference] =
    val form       = PolicyLanes.get(policy)
    val parameters = form.parametersOf(policy)
    val ours       = lanes.made(k)
    val seen       = form.inputsOf(scalar.seen(k), scalar.before(k))
    // Angles a turn apart are one.
    val heading = PolicyLanes.In.Heading
    seen(heading) += 2 * math.Pi * math.rint((ours.inputs(heading)(world) - seen(heading)) / (2 * math.Pi))
    val off = seen.indices.map(i => math.abs(ours.inputs(i)(world) - seen(i))).toArray
    // Until decisions part, the vehicles are where they are in doubles.
    if math.max(off(0), off(1)) >= MostOffM then
      throw AssertionError(s"world $world, agent $agent, decision $k: ${off(0)} and ${off(1)} m off")
    def bound(isSame: Boolean)  = ErrorBound.of(form.outputs, seen, off, parameters, isSame)
    def apart(most: ErrorBound) = form.outputs.take(2).zip(ours.outputs).map: (node, lane) =>
      (math.abs(lane(world) - most.value(node)), most.error(node))
    val asDoubles = apart(bound(true))
    Option.when(asDoubles.exists((by, most) => !(by <= most))):
      val either = bound(false)
      Difference(agent, k, apart(either), asDoubles, either.undecided(form.outputs))

  /** What one decision was made from and came to, by input or output, then by world. */
  final case class Made(inputs: Vector[Array[Float]], outputs: Vector[Array[Float]])

  final class Logged(of: Policy) extends LanePolicy(PolicyLanes.get(of)):
    val made: ArrayBuffer[Made] = ArrayBuffer.empty

    override def decide(
        observation: LaneObservation,
        own: Directions,
        ownAt: Int,
        known: Directions,
        knownAt: Int,
        into: Directions,
        intoAt: Int
    ): Unit =
      super.decide(observation, own, ownAt, known, knownAt, into, intoAt)
      made += Made(lastInputs, lastOutputs)

  /** Notes what a policy sees, and answers as it does. */
  final class Log(policy: Policy) extends ObservingPolicy[Any]:
    val seen: ArrayBuffer[PlanarObservation] = ArrayBuffer.empty
    val before: ArrayBuffer[Any]             = ArrayBuffer.empty
    def initial: Any                         =
      seen.clear()
      before.clear()
      ObservingPolicy.initialOf(policy)
    def decide(observed: PlanarObservation, memory: Any): Decided[Any] =
      seen += observed
      before += memory
      ObservingPolicy.decide(policy, observed, memory)

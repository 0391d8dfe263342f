package skein.lanes

import scala.collection.mutable.ArrayBuffer
import skein.forward.{
  DelayTable,
  RolloutAgent,
  Engagement,
  Grounds,
  LoopObserver,
  LoopTiming,
  Rollout,
  VelocityResponses
}
import skein.lanes.policy.{LaneObservation, TeamLanes, VehicleNumbers}
import skein.lanes.timetable.{Timetable, TimetableAgents, TimetableKernel, TimetableScores}
import skein.policy.{Action, Observation, Policy}
import skein.scenario.{Crossing, Formation, Scenario, Surround}
import skein.signal.SplitMix64
import skein.simd.{BoundFunction, WorldRandom}
import skein.testing.Unhurried

/** A team's SIMD and scalar engines make equal decisions in every world, except where a number that a policy
  * compares is so near to another that rounding decides; [[ErrorBound]] computes how near.
  */
class TeamAgreementSimulation extends munit.FunSuite, Unhurried:
  import TeamAgreementSimulation.*

  private val plant  = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)
  private val worlds = TimetableKernel.WORLDS

  private def within(random: SplitMix64, least: Double, most: Double) =
    least + (most - least) * random.nextDouble()

  private val scenarios: Seq[(String, SplitMix64 => Scenario)] = Seq(
    "surround"  -> (random => Surround(6, ringM = within(random, 5, 12), pursuerMps = within(random, 6, 12))),
    "formation" -> (random =>
      Formation(5, spacingM = within(random, 3, 6), leaderMps = within(random, 3, 6))
    ),
    "crossing" -> (random =>
      Crossing(4, entryM = 15, laneM = within(random, 1, 4), marginM = within(random, 0.5, 2))
    )
  )

  for
    (name, draw) <- scenarios
    timing       <- Seq(LoopTiming.Stream(), LoopTiming.Sequential())
  do
    test(s"$name, ${timing.productPrefix}: all compared worlds have equal decisions for 6 s"):
      val seed   = 23L
      val random = SplitMix64(seed)
      val drawn  = Vector.fill(worlds)(Engagement.of(draw(random).fleet, 6))
      val key    = WorldRandom.key(2, 0, 0)
      val model  = LaneDynamics.of(plant).fold(fail(_), identity)
      val lanes  =
        TeamLanes.of(policies(drawn.head), drawn.head.assignment, isPredicted = false).fold(throw _, identity)
      val team    = TeamViews(lanes)
      val agents  = Array.tabulate(lanes.count)(self => Logged(self, drawn.head.agents(self), model, team))
      val numbers =
        drawn.map(each => policies(each).zipWithIndex.map((policy, self) => lanes.numbersOf(self, policy)))
      for world <- 0 until worlds; self <- 0 until lanes.count do
        val own = numbers(world)(self)
        agents(self).take(world, VehicleNumbers(drawn(world).agents(self), own))
      TimetableKernel(agents.map(identity[TimetableAgents]), NoScores)
        .fly(Timetable.of(Vector.fill(lanes.count)(model), 6, timing, DelayTable.vpn, key), worlds)
      val forms     = Vector.tabulate(lanes.count)(self => Form(lanes, self))
      val agreement = Agreement()
      for world <- 0 until worlds by 7 do
        val logs   = policies(drawn(world)).map(Log(_))
        val all    = drawn(world)
        val flown  = all.copy(agents = all.agents.zip(logs).map((agent, log) => agent.copy(policy = log)))
        val events = Events(lanes.count)
        Rollout(flown, timing, DelayTable.vpn, plant).fly(key, observer = events): Unit
        val first = events.all.iterator
          .flatMap: (self, k, timeS) =>
            assert(k < agents(self).made.size, s"world $world: vehicle $self decides only $k times by lanes")
            forms(self).difference(
              k,
              timeS,
              logs(self).seen(k),
              agents(self).made.take(k + 1).takeRight(2).toVector,
              world,
              numbers(world)(self).parameters
            )
          .nextOption()
        agreement.add(world, first)(())
      agreement.check(s"seed $seed")

  private def policies(of: Engagement) = of.agents.map(_.policy)

object TeamAgreementSimulation:
  /** The inputs of one decision in all worlds, with the resulting velocities and directions. */
  final case class Made(
      readings: Vector[Array[Float]],
      cos: Array[Float],
      sin: Array[Float],
      elapsedS: Float,
      velocity: Vector[Array[Float]],
      nextCos: Array[Float],
      nextSin: Array[Float]
  )

  /** The computation of a vehicle's decision, with its inputs. */
  final class Form(lanes: TeamLanes, self: Int):
    import TeamLanes.Source
    private val bound = BoundFunction.of(lanes.outputs(self))
    private val north = bound.nodes.take(2)

    private def inputs(
        readings: Vector[Double],
        cos: Double,
        sin: Double,
        elapsed: Double,
        own: Array[Double]
    ) =
      bound.inputs.map: input =>
        lanes.reading(input) match
          case Some((vehicle, field)) => readings(field * lanes.count + vehicle)
          case None                   => lanes.source(input) match
              case Source.Cos               => cos
              case Source.Sin               => sin
              case Source.Elapsed           => elapsed
              case Source.Parameter(number) => own(number)
              case other                    => throw IllegalStateException(s"$other is not asked for here")

    /** The difference of a decision beyond the error bound for the branches taken in doubles.
      *
      * @param made the SIMD engine's previous decision, if there was one, and its present decision
      */
    def difference(
        k: Int,
        timeS: Double,
        seen: Observation,
        made: Vector[Made],
        world: Int,
        own: Array[Double]
    ): Option[Agreement.Departure] =
      def where    = s"world $world, vehicle $self, decision $k, at $timeS s"
      val now      = made.last
      val readings =
        Vector(seen.northM, seen.eastM, seen.northMps, seen.eastMps).flatMap(seen.vehicles.indices.map(_))
      val ours    = now.readings.map(_(world).toDouble)
      val cos     = StrictMath.cos(seen.headingRad)
      val sin     = StrictMath.sin(seen.headingRad)
      val doubles = inputs(readings, cos, sin, seen.elapsed.toSeconds, own)
      val floats  = inputs(ours, now.cos(world), now.sin(world), now.elapsedS, own)
      val away    = readings.zip(ours).map((x, y) => math.abs(x - y)).max
      munit.Assertions.assert(away < Agreement.mostOff(timeS), s"$where: $away off in a reading")
      munit.Assertions.assertEqualsDouble(now.elapsedS, seen.elapsed.toSeconds, 1e-6, where)
      // The vehicle's own direction is that decided before.
      if made.size == 1 then munit.Assertions.assertEqualsDouble(now.cos(world), cos, 1e-6, where)
      else
        munit.Assertions.assertEquals(now.cos(world), made.head.nextCos(world), where)
        munit.Assertions.assertEquals(now.sin(world), made.head.nextSin(world), where)
      Agreement.departure(
        self,
        k,
        timeS,
        north,
        doubles,
        doubles.zip(floats).map((x, y) => math.abs(x - y)),
        Array.emptyDoubleArray,
        now.velocity.map(_(world).toDouble)
      )

  /** Records the scalar engine's decisions in order: vehicle, index from 0, and time. */
  final class Events(count: Int) extends LoopObserver:
    val all: ArrayBuffer[(Int, Int, Double)] = ArrayBuffer.empty
    private val decisions                    = Array.ofDim[Int](count)

    override def decided(vehicle: Int, atNs: Long, elapsedS: Double, upon: Grounds): Unit =
      all += ((vehicle, decisions(vehicle), atNs * 1e-9))
      decisions(vehicle) += 1

  final class Logged(self: Int, agent: RolloutAgent, model: LaneDynamics, team: TeamViews)
      extends TeamAgents(self, agent, model, team, Vector.fill(team.lanes.count)(agent.altitudeDownM)):
    val made: ArrayBuffer[Made] = ArrayBuffer.empty

    override def decide(
        all: Array[TimetableAgents],
        views: Array[Int],
        view: Int,
        known: Int,
        before: Int,
        after: Int,
        times: Array[Float],
        number: Int
    ): Unit =
      def copied(from: Array[Float], at: Int) =
        java.util.Arrays.copyOfRange(from, at, at + TimetableKernel.WORLDS)
      val readings =
        for field <- Vector.range(0, LaneObservation.READ); vehicle <- all.indices
        yield copied(all(vehicle).vehicles.seen(field), views(view + vehicle) * TimetableKernel.WORLDS)
      val (cos, sin) = (direction._1.clone, direction._2.clone)
      super.decide(all, views, view, known, before, after, times, number)
      made += Made(
        readings,
        cos,
        sin,
        times(number),
        Vector(copied(headings.cos, after), copied(headings.sin, after)),
        direction._1.clone,
        direction._2.clone
      )

  /** Records the observations of a policy, and passes on its decisions. */
  final class Log(val policy: Policy) extends Policy:
    val seen: ArrayBuffer[Observation] = ArrayBuffer.empty
    type Memory = policy.Memory
    def start: Memory                                                   = policy.start
    override def isPlanar: Boolean                                      = true
    def choose(observed: Observation, memory: Memory): (Action, Memory) =
      seen += observed
      policy.choose(observed, memory)

  object NoScores extends TimetableScores:
    def start(worlds: Int): Unit = ()
    def score(
        agents: Array[TimetableAgents],
        views: Array[Int],
        view: Int,
        timeS: Float
    ): Unit = ()

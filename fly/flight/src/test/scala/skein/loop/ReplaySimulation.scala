package skein.loop

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.ExecutionContext
import skein.loop.planning.CountedPlanWorkers
import skein.policy.*
import skein.record.{DecisionRow, Difference, MemoryRecorder, Recording, Samples}
import skein.scenario.PaperDuel
import skein.signal.LatencyProfile
import skein.testing.Optimised
import skein.units.*
import skein.vtime.VirtualTime

/** The decisions that a replay repeats, and the changes of a recording that it finds. */
class ReplaySimulation extends munit.FunSuite, Optimised:
  private val planning = PlanSettings(horizonSteps = 10, searches = 1, slices = 2, blocksPerSlice = 1)

  private def flown(kind: LoopKind, fleet: Fleet): Recording = VirtualTime
    .run(seed = 3): system =>
      given ActorSystem      = system
      given ExecutionContext = system.dispatcher
      val clock              = Clock.ofNanos(VirtualTime.clock(system))
      val world              = FarQuadrotors(fleet, LatencyProfile.vpn, 3, clock)
      val heading            = Samples.heading.copy(flight = Samples.heading.flight.copy(loop = kind.label))
      val recorder           = MemoryRecorder(heading)
      val settings           = LoopSettings(planning = planning, seed = heading.flight.seed)
      val workers            = CountedPlanWorkers(planning.searches, planning.slices)
      val team               = Team(fleet, world.ports, clock, recorder, settings, workers)
      Flight
        .start(kind, team, Some(world), Span.ofSeconds(2), clock, recorder)
        .outcome
        .map(_ => recorder.recording)
    .value

  private def found(fleet: Fleet, recording: Recording): Option[Difference] =
    Replay(fleet, recording, LoopSettings(planning = planning)).firstDifference

  private val duels = PaperDuel(pairs = 2).fleet

  /** Flies in the direction of the rest of the team, and away from its position. */
  private object Together extends Policy:
    type Memory = Unit
    def start: Unit                                             = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit) =
      val others = (0 until seen.count).filter(_ != seen.self)
      val north  = others.map(other => seen.northM(other) + seen.northMps(other)).sum
      val east   = others.map(other => seen.eastM(other) - seen.eastMps(other)).sum
      (seen.along(math.atan2(east, north), 2), ())

  /** A separate slot beside all other slots, moving north. */
  private object Slot extends Policy, Goal:
    def mostMps: Double                                             = 6
    def wanted(seen: Observation, aheadS: Double): (Double, Double) = (3 * aheadS, 8.0 * seen.self)
    type Memory = Unit
    def start: Unit                                             = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit) = (seen.along(0, 3), ())

  private def team(policy: Policy) = Fleet(duels.agents.take(3).map(_.copy(policy = policy)))

  private def forged(recording: Recording, at: Int)(change: DecisionRow => DecisionRow): Recording =
    recording.copy(decisions = recording.decisions.updated(at, change(recording.decisions(at))))

  private def turned(decision: DecisionRow) =
    decision.copy(heading = Radians(decision.heading.value + 1e-12))

  private val flights =
    LoopKind.values.toSeq.map(kind => (s"${kind.label}, two duels", kind, duels)) ++
      LoopKind.values.toSeq.filter(_ != LoopKind.Plan).map(kind =>
        (s"${kind.label}, a team", kind, team(Together))
      ) :+ ("plan, a team", LoopKind.Plan, team(Slot))

  for (name, kind, fleet) <- flights do
    test(s"$name: a replay makes equal decisions, and finds any changed decision, also the last one"):
      val recording = flown(kind, fleet)
      val decisions = recording.decisions
      assert(decisions.size > 10, decisions.size.toString)
      assertEquals(found(fleet, recording), None)
      for at <- Seq(7, decisions.size - 1) do
        val difference = found(fleet, forged(recording, at)(turned)).getOrElse(fail(s"decision $at: none"))
        assertEquals(difference.where, s"decision ${decisions(at).sequence} of ${decisions(at).vehicle}")
        assertEquals(difference.column, "headingRad")

  test("a replay accepts a vehicle's own speed, recorded or not, and finds another speed"):
    val recording             = flown(LoopKind.Stream, duels)
    def stated(share: Double) = recording.copy(decisions = recording.decisions.map: decision =>
      val own = duels.agents.find(_.name == decision.vehicle).get.speed
      decision.copy(speed = Some(MetresPerSecond(share * own.value))))
    assert(recording.decisions.forall(_.speed.isEmpty))
    assertEquals(found(duels, stated(1)), None)
    assertEquals(found(duels, stated(0.5)).map(_.column), Some("speedMps"))

  test("a recording truncated within a joint decision is compared up to that decision"):
    val recording = flown(LoopKind.Plan, team(Slot))
    val last      = recording.decisions.size - 1
    val broken    = recording.copy(decisions = recording.decisions.init)
    assertEquals(recording.decisions(last - 1).decidedAt, recording.decisions(last).decidedAt)
    assertEquals(found(team(Slot), broken), None)
    // The incomplete last decision is not compared; those before it are.
    assertEquals(found(team(Slot), forged(broken, last - 1)(turned)), None)
    assert(found(team(Slot), forged(broken, last - 4)(turned)).isDefined)

  test("a missing part of a joint decision is found unless it is the last one"):
    val recording = flown(LoopKind.Plan, team(Slot))
    val lacking   = recording.copy(decisions = recording.decisions.patch(30, Nil, 1))
    assert(found(team(Slot), lacking).exists(_.column == "vehicle"), found(team(Slot), lacking).toString)

  test(
    "a team's plans are recorded with the regarded vehicles, their speeds, and the errors of predictions"
  ):
    val recording = flown(LoopKind.Plan, team(Slot))
    val names     = team(Slot).agents.map(_.name)
    assert(recording.decisions.forall(_.speed.isDefined))
    assertEquals(recording.sightings.size, recording.decisions.size)
    assertEquals(recording.predictions.map(one => (one.decider, one.vehicle)).toSet, names.zip(names).toSet)

  test("a replay compares a team's decision with its recorded sightings"):
    val fleet     = team(Together)
    val recording = flown(LoopKind.Stream, fleet)
    val sighting  = recording.sightings(40)
    val where     = s"decision ${sighting.decision} of ${sighting.decider}"
    val unseen    = recording.copy(sightings = recording.sightings.patch(40, Nil, 1))
    assertEquals(
      found(fleet, unseen).map(one => (one.where, one.recorded, one.again)),
      Some((where, sighting.vehicle, "missing in the table of sightings"))
    )
    def reading(number: Long) =
      found(
        fleet,
        recording.copy(sightings = recording.sightings.updated(40, sighting.copy(reading = number)))
      )
    assertEquals(reading(9999).map(_.again), Some("no such reading"))
    assertEquals(
      reading(sighting.reading - 1).map(one => (one.where, one.column)),
      Some((where, "headingRad"))
    )

  test(
    "a replay finds a decision on a reading or a command that is missing or was changed"
  ):
    val recording = flown(LoopKind.Stream, duels)
    val decision  = recording.decisions(20)
    val where     = s"decision ${decision.sequence} of ${decision.vehicle}"
    def lost      = recording.readings.filterNot(one =>
      one.vehicle == decision.opponent.vehicle && one.sequence == decision.opponent.sequence
    )
    assertEquals(
      found(duels, recording.copy(readings = lost)).map(one => (one.column, one.again)),
      Some(("opponentSequence", "missing in the table of readings"))
    )
    val since = decision.observations.sinceOwnMove.getOrElse(fail("it knew of no move of its own"))
    val late  = forged(recording, 20)(one =>
      one.copy(observations = one.observations.copy(sinceOwnMove = Some(since + Span.ofNanos(1))))
    )
    assertEquals(
      found(duels, late).map(one => (one.where, one.column, one.again)),
      Some((where, "sinceOwnMoveMs", "no command was sent then"))
    )
    val stranger = forged(recording, 20)(_.copy(vehicle = "Nobody"))
    assertEquals(found(duels, stranger).map(_.again), Some("no vehicle of the scenario"))

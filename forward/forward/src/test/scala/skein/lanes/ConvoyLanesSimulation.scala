package skein.lanes

import skein.forward.*
import skein.lanes.score.{Judged, OfMoment}
import skein.policy.{Action, Observation, Policy}
import skein.scenario.{Convoy, OverFlight}
import skein.simd.WorldRandom
import skein.testing.{Optimised, Unhurried}
import skein.units.Vector3
import skein.vehicle.{ReducedModel, TiltModel, VehicleKind}

/** Cars and drones in one team, with SIMD and by the scalar engine. */
class ConvoyLanesSimulation extends munit.FunSuite, Optimised, Unhurried:
  import ConvoyLanesSimulation.*

  private val drag       = PlantResponse(ReducedModel.airSimAt(10))
  private val tilt       = SpatialResponse(TiltModel.AirSim)
  private val quadrotor  = VelocityResponses.quadrotor()
  private val predictive = LoopTiming.Predictive(predictor = drag.predictor)

  for
    (name, model, timing, shared) <- Seq(
      ("drag", drag, LoopTiming.Paused(), true),
      ("drag", drag, LoopTiming.Futures(), true),
      ("drag", drag, LoopTiming.Stream(), true),
      ("drag", drag, predictive, true),
      ("drag", drag, LoopTiming.Sequential(), false),
      ("drag", drag, LoopTiming.Stream(), false),
      ("drag", drag, predictive, false),
      ("tilt", tilt, LoopTiming.Stream(), true),
      ("tilt", tilt, LoopTiming.Stream(), false),
      ("tilt", tilt, LoopTiming.Predictive(predictor = tilt.predictor), true),
      ("tilt", tilt, LoopTiming.Predictive(predictor = tilt.predictor), false),
      ("quadrotor", quadrotor, LoopTiming.Stream(), true)
    )
  do
    val delays = if shared then "shared" else "own"
    test(
      s"a convoy with $name, ${timing.productPrefix}, $delays delays: all vehicles are where the scalar engine has them"
    ):
      val candidates = Vector.tabulate(Worlds): number =>
        candidate(Convoy(gapM = 10 + 0.2 * number, carMps = 5 + 0.1 * number), 6)
      assertAgree(model, timing, shared, candidates)

  test("a car starts along its heading, also where candidates differ in it"):
    val candidates = Vector.tabulate(Worlds): number =>
      changed(candidate(Convoy(), 5)): agent =>
        if agent.kind == VehicleKind.Car then agent.copy(startHeadingRad = 0.5 * (number % 3)) else agent
    assertAgree(drag, LoopTiming.Stream(), shared = true, candidates)

  test("a car's path differs from that of a drone in its place"):
    val cars            = candidate(Convoy(), 8)
    val drones          = changed(cars)(_.copy(kind = VehicleKind.Multirotor))
    val Seq(one, other) =
      Seq(cars, drones).map(each => fly(drag, LoopTiming.Stream(), true, Vector(each)).map(_(0)))
    val apartM = one.zip(other).take(2).map(_ - _)
    assert(apartM.exists(_.abs > 0.5), apartM)

  test("a car ignores the vertical part of its commands, also beside drones that must fly level"):
    val candidates = Vector.tabulate(Worlds): number =>
      changed(candidate(Convoy(), 5)): agent =>
        if agent.kind == VehicleKind.Car then agent.copy(policy = Upwards(3 + 0.1 * number)) else agent
    assertAgree(drag, LoopTiming.Stream(), shared = true, candidates)

  test("a GPU does not fly such a team as if all were drones"):
    def refusal(kind: VehicleKind) =
      TeamForms(
        LoopTiming.Stream(),
        drag
      ).of(changed(candidate(Convoy(), 5))(_.copy(kind = kind))).fold(fail(_), _.refusedByGpu)
    assertEquals(refusal(VehicleKind.Multirotor), None)
    assertEquals(refusal(VehicleKind.Car), Some("the GPU flies vehicles of one model"))

  private def changed(team: TeamCandidate)(by: RolloutAgent => RolloutAgent) =
    TeamCandidate(team.engagement.copy(agents = team.engagement.agents.map(by)), team.judged)

  private def assertAgree(
      model: VelocityResponse,
      timing: LoopTiming,
      shared: Boolean,
      candidates: Vector[TeamCandidate]
  ): Unit =
    val flown  = fly(model, timing, shared, candidates)
    val scalar = ScalarTeam(timing, model)
    for world <- candidates.indices by 9 do
      val truth = scalar.fly(candidates(world), DelayTable.vpn, key(shared, world))
      for (value, number) <- truth.zipWithIndex do
        assertEqualsDouble(flown(number)(world).toDouble, value, MostOffM, s"world $world, number $number")

  private def fly(
      model: VelocityResponse,
      timing: LoopTiming,
      shared: Boolean,
      candidates: Vector[TeamCandidate]
  ): Vector[Array[Float]] =
    val batch  = TeamBatch(timing, model, threads = 1)
    val engine = batch.engine(candidates.head, shared, Seq(DelayTable.vpn))
    assert(engine.fliesByLanes, engine.text)
    batch.fly(new TeamWorlds:
      def size: Int                            = candidates.size
      override def shareEpisodes: Boolean      = shared
      def key(world: Int): Int                 = ConvoyLanesSimulation.key(shared, world)
      def link(world: Int): Delays             = DelayTable.vpn
      def candidate(world: Int): TeamCandidate = candidates(world)).values

object ConvoyLanesSimulation:
  private val Worlds   = 40
  private val MostOffM = 4e-3

  private def key(shared: Boolean, world: Int) = WorldRandom.key(11, 0, if shared then world / 20 else world)

  private final case class Upwards(mps: Double) extends Policy:
    type Memory = Unit
    def start: Unit                                             = ()
    def choose(seen: Observation, memory: Unit): (Action, Unit) =
      (Action.Velocity(Vector3(mps, 0.1 * seen.northM(seen.self), -1)), ())

  /** A convoy, judged by where its vehicles are at the end, then by its measures. */
  def candidate(convoy: Convoy, durationS: Double): TeamCandidate =
    val engagement = Engagement.inSpace(convoy.fleet, durationS)
    val places     = engagement.agents.indices.toVector.flatMap: vehicle =>
      Vector(Judged(North(vehicle), OfMoment.Newest, 0), Judged(East(vehicle), OfMoment.Newest, 0))
    val measures = convoy.measures.flatMap(_.reduced).map:
      case OverFlight(quantity, reduction, _) => Judged(quantity, reduction, 2)
    TeamCandidate(engagement, places ++ measures)

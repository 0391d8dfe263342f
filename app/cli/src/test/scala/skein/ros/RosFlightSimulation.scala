package skein.ros

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{Future, Promise}
import skein.airsim.{Vehicles, WorldSettings}
import skein.flight.{FlightAssembler, VehicleSource}
import skein.link.*
import skein.loop.{FlightOutcome, LoopKind, PlanSettings}
import skein.policy.{Action, Yaw}
import skein.port.{VehicleError, VehiclePort}
import skein.record.{MemoryRecorder, Recording}
import skein.settings.FlySettings
import skein.signal.{Kinematics, LatencyProfile, Stamped}
import skein.simulator.{SimulatorServer, SimulatorSettings}
import skein.testing.Optimised
import skein.units.*
import skein.vtime.VirtualTime

/** Flights by odometry and `cmd_vel` in virtual time: all of `fly --ros` and `serve --ros` except for the
  * middleware, which is replaced by a function call.
  */
class RosFlightSimulation extends munit.FunSuite, Optimised:
  private def settings(loop: LoopKind, seconds: Double) = FlySettings(
    List(loop),
    List(LatencyProfile.none),
    Span.ofSeconds(seconds),
    Span.ofMillis(100),
    seed = 1,
    planning = PlanSettings(horizonSteps = 10, slices = 2, blocksPerSlice = 1)
  )

  /** A vehicle without topics between: its true state is read, and it performs equal velocities. */
  private final class Direct(server: SimulatorServer, index: Int, clock: Clock) extends VehiclePort:
    import scala.concurrent.ExecutionContext.parasitic
    private var flying = Promise[Either[VehicleError, Boolean]]()

    def read(): Future[Either[VehicleError, Stamped[Kinematics]]] =
      val sentAt = clock.now()
      server.truth().map(truth =>
        Right(Stamped(truth.vehicles(index).kinematics, truth.at, sentAt, clock.now()))
      )(using
        parasitic
      )

    def act(action: Action, lasts: Span): Future[Either[VehicleError, Boolean]] =
      flying.trySuccess(Right(false)): Unit
      flying = Promise()
      server.act(
        index,
        now =>
          TwistCommand.of(action, now).toOption.map(twist =>
            val v = twist.linear
            Action.Velocity(RosFrames.swapWorld(Vector3(v.x, v.y, v.z)), Yaw.Turning(-twist.angular.z))
          ).get,
        Some(lasts)
      )
      flying.future

    def hover(): Future[Either[VehicleError, Boolean]] =
      act(Action.Hover, Span.ofSeconds(1)): Unit
      Future.successful(Right(true))

  /** @param byTopics whether odometry and commands are sent as messages */
  private def flown(
      settings: FlySettings,
      byTopics: Boolean = true
  ): Either[String, (FlightOutcome, Recording)] = VirtualTime
    .run(seed = 1): system =>
      given ActorSystem = system
      import system.dispatcher
      val clock    = Clock.ofNanos(VirtualTime.clock(system))
      val network  = MemoryNetwork(NetworkPlan(LinkProfile.symmetric(LatencyProfile.none)), 1, clock)
      val agents   = settings.fleet.agents.map(Vehicles.settings)
      val world    = SimulatorSettings(WorldSettings(agents), Address("simulator", 41451))
      var vehicles = Vector.empty[RosVehicle]
      SimulatorServer
        .start(
          world,
          network.host("simulator"),
          clock,
          Some((at, seen) =>
            for (vehicle, motion) <- vehicles.zip(seen) do
              assertEquals(
                vehicle.receive(VehicleMessages.odometry(at, motion.name, motion.kinematics)),
                Right(())
              )
          )
        )
        .flatMap: server =>
          vehicles = agents.zipWithIndex.map: (agent, index) =>
            RosVehicle(
              agent.name,
              s"/${agent.name}/odom",
              command =>
                VehicleCommands.velocity(agent.name, command.header.frameId, command.twist) match
                  case Right(action) => server.act(index, action, Some(VehicleCommands.VelocityLasts))
                  case Left(why)     => fail(why)
              ,
              clock
            )
          object source extends VehicleSource:
            val where                       = "ROS 2"
            override val guidance           = TwistCommand.guidance(_)
            def open(names: Vector[String]) =
              assertEquals(names, agents.map(_.name))
              Future
                .sequence(vehicles.map(_.isThere))
                .map(_ =>
                  Right(VehicleSource.Opened(
                    if byTopics then vehicles else agents.indices.map(Direct(server, _, clock)).toVector,
                    () => Option.when(byTopics)(vehicles.head.clocks).flatten,
                    () =>
                      vehicles.foreach(_.close())
                      Future.successful(Done)
                  ))
                )
          val assembler =
            FlightAssembler(network.host("controller"), clock, settings, None, elsewhere = Some(source))
          val plan   = settings.plans.head
          val memory = MemoryRecorder(assembler.heading(plan, "virtual"))
          for
            started <- assembler.start(plan, memory)
            flown   <- started match
              case Left(why)       => Future.successful(Left(why))
              case Right(assembly) => assembly.landed.map(landed => Right((landed.outcome, memory.recording)))
            _ <- server.close()
          yield flown
    .value

  /** Mean distance of the duel's vehicles over decisions of the second half, m. */
  private def distance(recording: Recording): Double =
    val decided = recording.decisions.filter(_.vehicle == "Pursuer")
    val late    = decided.drop(decided.size / 2)
    late
      .map(one => one.own.state.value.positionNed.horizontalDistance(one.opponent.state.value.positionNed))
      .sum / late.size

  // Odometry is up to 20 ms old, which `predictive` knows of and `stream` does not.
  for (loop, most) <- Seq(LoopKind.Stream -> 0.1, LoopKind.Predictive -> 0.05) do
    test(s"${loop.label} flies the duel by topics nearly as by equal velocities without them"):
      val Seq(topics, direct) = Seq(true, false).map: byTopics =>
        val (outcome, recording) = flown(settings(loop, 40), byTopics).fold(fail(_), identity)
        assertEquals(outcome, FlightOutcome.Completed)
        distance(recording)
      println(f"${loop.label}: $topics%.3f m by topics, $direct%.3f m without")
      assertEqualsDouble(topics / direct, 1, most)

  for (link, mostMm) <- Seq(LatencyProfile.none -> 5.0, LatencyProfile.vpn -> 50.0) do
    test(s"predictive foresees what commands of cmd_vel do, over ${link.name}"):
      val (_, recording) =
        flown(settings(LoopKind.Predictive, 40).copy(links = List(link))).fold(fail(_), identity)
      val errors      = recording.predictions.drop(40).map(_.error.value * 1e3).sorted
      def at(p: Int)  = errors(errors.size * p / 100)
      val (half, p95) = (at(50), at(95))
      println(
        f"${link.name}: $half%.1f mm off at the median, $p95%.1f mm at 95 %%, ${distance(recording)}%.3f m"
      )
      assert(p95 < mostMm, p95)

  for loop <- LoopKind.values if loop != LoopKind.Paused do
    test(s"${loop.label} flies by topics"):
      val (outcome, recording) = flown(settings(loop, 3)).fold(fail(_), identity)
      assertEquals(outcome, FlightOutcome.Completed)
      assert(recording.decisions.size > 20, recording.decisions.size)

  test("paused, and a link with a rate, are refused before anything moves"):
    assert(flown(settings(LoopKind.Paused, 3)).left.exists(_.contains("which vehicles of ROS 2 have not")))
    val slow = LatencyProfile.parse("rate:50mbit,vpn", Left(_)).fold(error => fail(error.message), identity)
    val over = settings(LoopKind.Stream, 3).copy(links = List(slow))
    assert(flown(over).left.exists(_.startsWith("expected a link without a rate to ROS 2")))

  test("over an emulated link, readings are older by its delay, and predictive predicts further"):
    def over(loop: LoopKind, link: LatencyProfile) =
      val (outcome, recording) = flown(settings(loop, 10).copy(links = List(link))).fold(fail(_), identity)
      assertEquals(outcome, FlightOutcome.Completed)
      recording
    def ageMs(recording: Recording) =
      val ages = recording.readings.map(_.state).map(state => state.receivedAt.since(state.validAt).toMillis)
      ages.sum / ages.size
    // Half a round trip of 200 ms, and up to 20 ms, the odometry's period.
    val link    = LatencyProfile.parse("constant:200ms", Left(_)).fold(error => fail(error.message), identity)
    val longer  = ageMs(over(LoopKind.Stream, link)) - ageMs(over(LoopKind.Stream, LatencyProfile.none))
    val further = over(LoopKind.Predictive, link).predictions.map(_.age.toMillis)
    assert(longer >= 100 && longer <= 121, longer)
    assert(further.sum / further.size > 190, further.sum / further.size)

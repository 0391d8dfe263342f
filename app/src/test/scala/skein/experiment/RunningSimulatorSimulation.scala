package skein.experiment

import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Future
import skein.airsim.{VehicleSettings, WorldSettings}
import skein.airsim.simulator.{SimulatorServer, SimulatorSettings}
import skein.link.*
import skein.loop.{LoopKind, Outcome}
import skein.record.{MemoryRecorder, Recording}
import skein.signal.LatencyProfile
import skein.units.*
import skein.vtime.VirtualTime

/** Flights against a simulator that runs already and goes on running, as AirSim does. */
class RunningSimulatorSimulation extends munit.FunSuite:
  private val settings = FlySettings(
    List(LoopKind.Stream, LoopKind.Paused, LoopKind.Predictive),
    List(LatencyProfile.direct),
    duration = Span.ofSeconds(8),
    period = Span.ofMillis(100),
    seed = 1,
    pairs = 1,
    asPublished = false
  )

  /** One after another, from vehicles on the ground. */
  private def flown(vehicles: Vector[VehicleSettings]): Either[String, Vector[Recording]] =
    VirtualTime
      .run(seed = 1): system =>
        given ActorSystem = system
        import system.dispatcher
        val clock   = Clock.ofNanos(VirtualTime.clock(system))
        val network = MemoryNetwork(NetworkPlan(), 1, clock).host("localhost")
        val world   =
          SimulatorSettings(
            WorldSettings(vehicles, text = WorldSettings.render(vehicles)),
            Address("127.0.0.1", 0)
          )
        SimulatorServer
          .start(world, network, clock)
          .flatMap: server =>
            val rigs = FlightRigs(network, clock, settings, Some(server.address))
            def fly(plan: FlightPlan): Future[Either[String, Recording]] =
              val recorder = MemoryRecorder(rigs.heading(plan, "virtual"))
              rigs
                .start(plan, recorder)
                .flatMap:
                  case Left(reason) => Future.successful(Left(s"${plan.id}: $reason"))
                  case Right(rig)   =>
                    rig.landed.map(landed =>
                      Either.cond(
                        landed.outcome == Outcome.Completed,
                        recorder.recording,
                        s"${plan.id}: ${landed.outcome}"
                      )
                    )
            settings.plans
              .foldLeft(Future.successful[Either[String, Vector[Recording]]](Right(Vector.empty))):
                (before, plan) =>
                  before.flatMap:
                    case Left(reason)      => Future.successful(Left(reason))
                    case Right(recordings) => fly(plan).map(_.map(recordings :+ _))
              .flatMap(result => server.close().map(_ => result))
      .value

  private def onGround(name: String, north: Double, east: Double) =
    VehicleSettings(name, Vector3(north, east, 0), Radians(0))

  test("every flight begins at rest at the starts, wherever the one before has left the vehicles"):
    flown(Vector(onGround("Evader", 0, 0), onGround("Pursuer", -20, 5))) match
      case Left(reason)      => fail(reason)
      case Right(recordings) =>
        assertEquals(recordings.size, 3)
        for
          recording <- recordings
          vehicle   <- recording.heading.vehicles
        do
          val first = recording.readings.filter(_.vehicle == vehicle.name).minBy(_.sequence)
          assert((first.state.value.positionNed - vehicle.startNed).norm < 0.8, s"$vehicle: $first")
          assert(first.state.value.velocityNed.norm < 0.1, s"$vehicle: $first")

  test("without one of the vehicles a flight is refused, with the names of those that are there"):
    assertEquals(
      flown(Vector(onGround("Evader", 0, 0))).left.map(_.replaceFirst("^[^:]*: ", "")),
      Left("the simulator has no vehicle 'Pursuer'; it has 'Evader'")
    )

package rovers

import com.typesafe.config.{Config, ConfigFactory}
import java.nio.file.{Files, Path}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{ExecutionContext, Future}
import scala.concurrent.duration.DurationInt
import skein.forward.PlantResponse
import skein.link.{Address, MemoryNetwork, NetworkPlan}
import skein.flight.{PortFlight, Replayed}
import skein.loop.{LoopKind, LoopSettings, OwnLoop, Replay}
import skein.measure.FlightSummary
import skein.policy.{Action, Agent, LeadOnCircuit, Racetrack, Role}
import skein.port.VehicleError
import skein.record.{ClockKind, MemoryRecorder, Recording}
import skein.report.Report
import skein.scenario.{Scenario, Scenarios}
import skein.settings.{ModelFile, PredictionModel, VehicleChoice}
import skein.signal.{Kinematics, LatencyProfile}
import skein.testing.TemporaryFolders
import skein.units.*
import skein.vehicle.{PlantModel, Setpoint, VehicleModel}
import skein.vtime.VirtualTime

/** A model without a plant: the vehicle stays at its last reading. */
private object Coasting extends VehicleModel[Kinematics]:
  def start(seen: Kinematics): Kinematics                                         = seen
  def advanced(state: Kinematics, setpoint: Setpoint, span: Span): Kinematics     = state
  def corrected(state: Kinematics, seen: Kinematics, sinceSeen: Span): Kinematics = seen
  def kinematics(state: Kinematics): Kinematics                                   = state

/** Two robots on a circuit whose turns are too narrow for their speed. */
private final case class Laps(mps: Double = 2) extends Scenario:
  val circuit: Racetrack    = Racetrack(straightM = 8, radiusM = 1.5)
  def agents: Vector[Agent] =
    for (name, alongM) <- Vector("One" -> 0.0, "Other" -> circuit.lengthM / 2)
    yield
      val (north, east) = circuit.point(alongM)
      val policy        = LeadOnCircuit(circuit, mps, aheadM = 1)
      Agent(name, Role.Traveller, MetresPerSecond(mps), Vector3(north, east, 0), Radians(0), policy)

class RoverSimulation extends munit.FunSuite, TemporaryFolders:
  import Program.scenarios
  // Fits take seconds, and longer on a busy machine.
  override val munitTimeout = 2.minutes
  private val loops         =
    Seq[LoopKind | OwnLoop](
      LoopKind.Sequential,
      LoopKind.Futures,
      LoopKind.Stream,
      LoopKind.Predictive,
      LoopKind.Plan,
      turns
    )

  private def distances(recording: Recording): Seq[(Double, Double)] =
    FlightSummary.of(recording).result.get.curves.head._2.points

  for loop <- loops do
    test(
      s"${loop.label}: after 10 s the hound is close behind the hare, and the recording repeats all " +
        "decisions"
    ):
      val recorder  = Chase.virtual(loop, Span.ofSeconds(16), seed = 1)
      val recording = recorder.recording
      assertEquals(recording.ending.map(_.how.toString), Some("Completed"))
      for (atS, distance) <- distances(recording) if atS > 10 do
        assert(distance > 0.5 && distance < 3.5, s"$distance m at $atS s")
      assertEquals(replayed(recorder).decidedAgain, None)

  private def fileOf(recorder: MemoryRecorder): Path =
    val file = temporaryFolder().resolve("drive.duckdb")
    assert(recorder.writeTo(file).isRight)
    file

  /** Replays a recording by the command `replay`. */
  private def replayed(recorder: MemoryRecorder): Replayed =
    Replayed.of(fileOf(recorder)).fold(fail(_), identity)

  /** Mean distance of the hound from its goal behind the hare after 10 s, m. */
  private def offM(recording: Recording): Double =
    val hare  = recording.readings.filter(_.vehicle == "Hare").map(_.state)
    val hound = recording.readings.filter(_.vehicle == "Hound").map(_.state)
    val offs  =
      for at <- hound if at.validAt.since(hound.head.validAt).toSeconds > 10
      yield
        val near = hare.minBy(other => math.abs(other.validAt.since(at.validAt).toNanos))
        val v    = near.value.velocityNed
        val goal =
          near.value.positionNed + v * at.validAt.since(near.validAt).toSeconds - v * (1 / v.norm.max(0.1))
        goal.horizontalDistance(at.value.positionNed)
    offs.sum / offs.size

  private val slow = PredictionModel.Own(RoverPlant.structure, Vector(1, 0.5, 1.2, 0))

  test("with plans by its own plant, the hound reaches its goal behind the hare, where its policy lags"):
    def off(loop: LoopKind) =
      offM(Chase.virtual(loop, Span.ofSeconds(20), seed = 1, LatencyProfile.direct).recording)
    val (planned, byPolicy) = (off(LoopKind.Plan), off(LoopKind.Predictive))
    assert(planned < 0.3, s"$planned m")
    assert(byPolicy > 1, s"$byPolicy m")

  test("on a circuit with narrow turns, plans by the robots' own plant stay on it; those of another do not"):
    val laps                     = Laps()
    def off(by: PredictionModel) =
      val driven =
        Chase.virtual(LoopKind.Plan, Span.ofSeconds(12), 1, LatencyProfile.direct, by, laps).recording
      val offs = driven.readings.map(_.state.value.positionNed).map: at =>
        val (north, east) = laps.circuit.point(laps.circuit.nearest(at.x, at.y))
        at.horizontalDistance(Vector3(north, east, 0))
      offs.sum / offs.size
    val own = off(Chase.rover)
    assert(own < 0.2, s"$own m")
    for other <- Seq(PredictionModel.AirSimDrag, slow) do
      val by = off(other)
      assert(own < by / 2, s"$own m by the own plant, $by m by $other")

  test("the plant, and the heading of a robot at rest, are recorded; with another plant its plans differ"):
    val recorder  = Chase.virtual(LoopKind.Plan, Span.ofSeconds(5), seed = 1)
    val recording = recorder.recording
    assert(recording.planned.forall(_.states.exists(_.own.size == 4)))
    val settings = LoopSettings(planning = Chase.planning, model = _ => slow.at(0))
    assert(Replay(Rovers().fleet, recording, settings).firstDifference.isDefined)
    assertEquals(
      Replayed.of(
        fileOf(recorder)
      )(using Scenarios.ours.copy(kinds = Program.scenarios.kinds)).left.map(_.takeWhile(_ != ',')),
      Left("its parameter 'predictor': expected a model's name or five numbers")
    )

  test("a model unfit for planning is refused before the drive, with the reason"):
    val coasting = LoopSettings(model = _ => Coasting)
    val said     = intercept[IllegalArgumentException]:
      PortFlight(
        "coasting",
        LoopKind.Plan,
        Rovers(),
        Span.ofSeconds(1),
        ClockKind.Virtual,
        Clock.system,
        coasting
      )
    assert(said.getMessage.startsWith("Hound: expected a model of a plant"), said.getMessage)

  test("equal seeds give equal recordings"):
    def digest = Chase.virtual(LoopKind.Stream, Span.ofSeconds(10), seed = 7).digest
    assertEquals(digest, digest)

  test("recordings become a report"):
    val folder = temporaryFolder()
    val files  =
      for loop <- Seq[LoopKind | OwnLoop](LoopKind.Stream, turns) yield
        val file = folder.resolve(s"${loop.label}.duckdb")
        assert(Chase.virtual(loop, Span.ofSeconds(12), seed = 1).writeTo(file).isRight)
        file
    val set    = Report.read(files).fold(errors => fail(errors.mkString), identity)
    val report = Report.write(set, folder).fold(fail(_), identity)
    val page   = Files.readString(report.page)
    for id <- Seq("stream-rovers-virtual", "turns-rovers-virtual") do assert(page.contains(id), id)

  /** The output of `identify` for a minute's drive. */
  private def identified(seed: Long, link: LatencyProfile): Path =
    val folder = temporaryFolder()
    val file   = folder.resolve("drive.duckdb")
    assert(Chase.virtual(LoopKind.Stream, Span.ofSeconds(60), seed, link).writeTo(file).isRight)
    assertEquals(Program.run(Seq("identify", file.toString, "--structure", "rover")), 0)
    folder.resolve("model.conf")

  private lazy val withoutDelay = identified(seed = 1, LatencyProfile.none)

  test("identify finds the robots' parameters within its intervals if the link has no delay"):
    val model = modelOf(withoutDelay)
    for (name, value) <- Seq("turn-per-s" -> 3.0, "most-rad-per-s" -> 1.5, "lag-s" -> 0.4) do
      val (least, most) = (model.getDouble(s"$name.least"), model.getDouble(s"$name.most"))
      // The file has six digits.
      assert(least - 1e-5 <= value && value <= most + 1e-5, s"$name: $least to $most")
      assertEqualsDouble(model.getDouble(s"$name.value"), value, 1e-3 * value, name)

  test(
    "with a link delay, identify finds the parameters within 5 %, since it estimates when commands arrive"
  ):
    val model = modelOf(identified(seed = 2, LatencyProfile.direct))
    for (name, value) <- Seq("turn-per-s" -> 3.0, "most-rad-per-s" -> 1.5, "lag-s" -> 0.4) do
      assertEqualsDouble(model.getDouble(s"$name.value"), value, 0.05 * value, name)

  private def modelOf(file: Path): Config =
    ConfigFactory.parseFile(file.toFile).getConfig("skein.model.rover")

  test("a program reads models of its own structures; a program without them lists those it has"):
    val path = withoutDelay.toString
    val read = ModelFile.read(path).map(_.plant).fold(fail(_), identity)
    assertEquals(PredictionModel.parse(path).map(_.at(0)), Right(PlantModel(read)))
    assertEquals(VehicleChoice.parse(path, 20).map(_.response), Right(PlantResponse(read)))
    val said = ModelFile.read(path)(using Scenarios.ours).left.getOrElse("")
    assert(said.contains("expected a structure (lag, turn, drag, drag-and-turn), got 'rover'"), said)

  private def inVirtualTime[A](body: ActorSystem ?=> (MemoryNetwork, Clock) => Future[A]): A =
    VirtualTime
      .run(seed = 1): system =>
        given ActorSystem = system
        val clock         = Clock.ofNanos(VirtualTime.clock(system))
        body(MemoryNetwork(NetworkPlan(), 1, clock), clock)
      .value

  test("unsupported actions, an end of the connection and silence are reported as errors"):
    val (climbing, nobody) = inVirtualTime: (network, clock) =>
      given ExecutionContext = ExecutionContext.parasitic
      val host               = network.host("localhost")
      val nobody             = Rover(host, Address("localhost", 9), clock)
      for
        address  <- RoverSimulator(0, 0, clock, clock.now()).listen(host)
        climbing <- Rover(host, address, clock).act(Action.Land, Span.ofSeconds(1))
        answer   <- nobody.read()
      yield (climbing, answer)
    assert(climbing.left.exists(_.isInstanceOf[VehicleError.Unsupported]), climbing)
    assert(nobody.left.exists(_.isInstanceOf[VehicleError.Lost]), nobody)

  test("a drive ends by itself, and is ended by the next"):
    val (first, second) = inVirtualTime: (network, clock) =>
      given ExecutionContext = ExecutionContext.parasitic
      val host               = network.host("localhost")
      for
        address <- RoverSimulator(0, 0, clock, clock.now()).listen(host)
        rover  = Rover(host, address, clock)
        first  = rover.act(Action.VelocityAt(1, 0, Metres(0)), Span.ofSeconds(5))
        second = rover.act(Action.VelocityAt(0, 1, Metres(0)), Span.ofSeconds(5))
        ended <- first.zip(second)
      yield ended
    assertEquals((first, second), (Right(false), Right(true)))

package rovers

import com.typesafe.config.ConfigFactory
import java.nio.file.Files
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.{ExecutionContext, Future}
import skein.forward.PlantResponse
import skein.link.{Address, MemoryNetwork, NetworkPlan}
import skein.loop.{LoopKind, OwnLoop, Replay}
import skein.measure.FlightSummary
import skein.policy.Action
import skein.port.VehicleError
import skein.record.Recording
import skein.report.Report
import skein.scenario.Scenarios
import skein.settings.{ModelFile, PredictionModel, VehicleChoice}
import skein.units.*
import skein.vehicle.PlantModel
import skein.vtime.VirtualTime

class RoverSimulation extends munit.FunSuite:
  import Program.scenarios
  private val loops =
    Seq[LoopKind | OwnLoop](
      LoopKind.Sequential,
      LoopKind.Futures,
      LoopKind.Stream,
      LoopKind.Predictive,
      turns
    )

  private def distances(recording: Recording): Seq[(Double, Double)] =
    FlightSummary.of(recording).result.get.curves.head._2.points

  for loop <- loops do
    test(
      s"${loop.label}: after 10 s the hound is at the hare's heels, and everything is decided again from the recording"
    ):
      val recording = Chase.virtual(loop, Span.ofSeconds(20), seed = 1).recording
      assertEquals(recording.ending.map(_.how.toString), Some("Completed"))
      for (atS, distance) <- distances(recording) if atS > 10 do
        assert(distance > 0.5 && distance < 3.5, s"$distance m at $atS s")
      assertEquals(Replay(Rovers().fleet, recording).firstDifference, None)

  test("equal seeds give equal recordings"):
    def digest = Chase.virtual(LoopKind.Stream, Span.ofSeconds(10), seed = 7).digest
    assertEquals(digest, digest)

  test("recordings become a report"):
    val folder = Files.createTempDirectory("rovers")
    val files  =
      for loop <- Seq[LoopKind | OwnLoop](LoopKind.Stream, turns) yield
        val file = folder.resolve(s"${loop.label}.duckdb")
        assert(Chase.virtual(loop, Span.ofSeconds(12), seed = 1).writeTo(file).isRight)
        file
    val set    = Report.read(files).fold(errors => fail(errors.mkString), identity)
    val report = Report.write(set, folder).fold(fail(_), identity)
    val page   = Files.readString(report.page)
    for id <- Seq("stream-rovers-virtual", "turns-rovers-virtual") do assert(page.contains(id), id)

  test("identify finds the robots' plant from their drives, and writes a file that this program reads back"):
    val folder = Files.createTempDirectory("rovers")
    val file   = folder.resolve("drive.duckdb")
    assert(Chase.virtual(LoopKind.Stream, Span.ofSeconds(60), seed = 1).writeTo(file).isRight)
    assertEquals(Program.run(Seq("identify", file.toString, "--structure", "rover")), 0)
    val path  = folder.resolve("model.conf").toString
    val model = ConfigFactory.parseFile(java.io.File(path)).getConfig("skein.model.rover")
    for (name, value) <- Seq("turn-per-s" -> 3.0, "most-rad-per-s" -> 1.5, "lag-s" -> 0.4) do
      val (least, most) = (model.getDouble(s"$name.least"), model.getDouble(s"$name.most"))
      assert(least <= value && value <= most && most - least < 0.2 * value, s"$name: $least to $most")
    val read = ModelFile.read(path).map(_.plant).fold(fail(_), identity)
    assertEquals(PredictionModel.parse(path).map(_.at(0)), Right(PlantModel(read)))
    assertEquals(VehicleChoice.parse(path, 20).map(_.response), Right(PlantResponse(read)))
    // Skein's own program does not know the structure, and says which it knows.
    val said = ModelFile.read(path)(using Scenarios.ours).left.getOrElse("")
    assert(said.contains("expected a structure (lag, turn, drag, drag-and-turn), came 'rover'"), said)

  private def inVirtualTime[A](body: ActorSystem ?=> (MemoryNetwork, Clock) => Future[A]): A =
    VirtualTime
      .run(seed = 1): system =>
        given ActorSystem = system
        val clock         = Clock.ofNanos(VirtualTime.clock(system))
        body(MemoryNetwork(NetworkPlan(), 1, clock), clock)
      .value

  test("what the robot cannot do, an end of the connection and silence are told as errors"):
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

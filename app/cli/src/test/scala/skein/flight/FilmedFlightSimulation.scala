package skein.flight

import java.nio.file.{Files, Path}
import scala.util.Using
import skein.cli.OurScenarios
import skein.loop.{LoopKind, FlightOutcome}
import skein.record.*
import skein.recognition.BlindPursuit
import skein.scenario.{Forest, Scenario, Scenarios}
import skein.settings.{FlySettings, ImageSource}
import skein.signal.LatencyProfile
import skein.testing.Optimised
import skein.units.*

/** Flights that record what their cameras and lidars see. */
class FilmedFlightSimulation extends munit.FunSuite, Optimised:
  private given Scenarios = OurScenarios.all

  private val folder = FunFixture[Path](
    _ => Files.createTempDirectory("filmed"),
    path =>
      Using.resource(Files.walk(path))(_.sorted(java.util.Comparator.reverseOrder()).forEach(Files.delete(_)))
  )

  private def fly(scenario: Scenario, loop: LoopKind, seconds: Double, images: ImageSource*): MemoryRecorder =
    val settings = FlySettings(
      List(loop),
      List(LatencyProfile.direct),
      Span.ofSeconds(seconds),
      Span.ofMillis(100),
      seed = 3,
      scenario,
      images = images.toList
    )
    val flown = VirtualFlights.fly(settings, settings.plans.last).fold(fail(_), identity)
    assertEquals(flown.landed.outcome, FlightOutcome.Completed)
    flown.recorder

  folder.test(
    "images of a policy's camera and of others are recorded, exported, and identical in a repeated flight"
  ): folder =>
    val flown = fly(
      BlindPursuit(),
      LoopKind.Predictive,
      1,
      ImageSource.Seen,
      ImageSource.Camera("bottom_center", 5)
    )
    val images = flown.records.collect { case image: CameraImage => image }
    val counts = images.groupMapReduce(one => (one.vehicle, one.camera, one.width, one.height))(_ => 1)(_ + _)
    assertEquals(
      counts.keySet,
      Set(
        ("Pursuer", "front_center", 800L, 600L),
        ("Pursuer", "bottom_center", 256L, 144L),
        ("Evader", "bottom_center", 256L, 144L)
      )
    )
    for (camera, count) <- counts do assert(count >= (if camera._2 == "front_center" then 6 else 3), counts)
    for image <- images do
      assertEquals(image.pixels.size.toLong, image.width * image.height * 3)
      val degrees = if image.camera == "front_center" then 100.0 else 90.0
      // No request had been made when the first were taken.
      for fov <- image.fov do assertEqualsDouble(fov.value, math.toRadians(degrees), 1e-6)
    assert(images.count(_.fov.isDefined) > images.size / 2)

    val file  = folder.resolve("filmed.duckdb")
    val mcap  = folder.resolve("filmed.mcap")
    val again = folder.resolve("again.duckdb")
    assert(flown.writeTo(file).isRight)
    assertEquals(McapRecording.write(file, mcap), Right(()))
    assertEquals(McapRecording.read(mcap, again), Right(()))
    assertEquals(Digest.ofFile(again), Right(flown.digest))
    val replayed = Replayed.of(file).fold(fail(_), identity)
    assert(replayed.isSame, s"$replayed")

  test("each of a lidar's clouds is recorded once, in its frame"):
    val clouds = fly(Forest(), LoopKind.Stream, 1, ImageSource.Seen).records.collect:
      case cloud: Cloud => cloud
    assert(clouds.sizeIs > 5, s"${clouds.size}")
    for (vehicle, own) <- clouds.groupBy(_.vehicle) do
      assertEquals(own.map(_.sequence), Vector.range(1L, own.size + 1L), vehicle)
      assertEquals(own.map(_.validAt).distinct.size, own.size, vehicle)
    for cloud <- clouds do assertEquals(cloud.xyz.size.toLong, cloud.points * 12)
    assert(clouds.exists(_.points > 100))

  test("a plan's course begins near the vehicle, and is as long as the horizon"):
    val flown = fly(skein.scenario.PaperDuel(), LoopKind.Plan, 1)
    val plans = flown.recording.planned.flatMap(_.course)
    assert(plans.nonEmpty)
    for course <- plans do
      assertEquals((course.north.size, course.east.size, course.step), (30, 30, Span.ofMillis(100)))
      val steps = course.north.zip(course.east).sliding(2).collect { case Vector((n0, e0), (n1, e1)) =>
        math.hypot(n1 - n0, e1 - e0)
      }
      // No vehicle is faster than 10 m/s, except for an overshoot of its controller.
      assert(steps.forall(_ < 1.2))

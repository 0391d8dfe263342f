package skein.rosbag

import java.nio.file.Files
import skein.record.MemoryRecorder
import skein.testing.{Lengthy, PythonEnvironment, TemporaryFolders}

/** Other people's bags: the Python package `rosbags`. */
class RosbagsLiveSuite extends munit.FunSuite, TemporaryFolders, Lengthy:
  private val python =
    PythonEnvironment("rosbags", Some("/rosbag/bags.py"), Seq("rosbags==0.11.9"))

  private def run(arguments: String*): String =
    val (status, said) = python.run("bags.py", arguments*)
    assertEquals(status, 0, said)
    said

  folder.test("rosbags reads our bags by the definitions in them, and finds the readings' ages"): folder =>
    val recorder: MemoryRecorder = Flown.stream(seconds = 10)
    val file                     = folder.resolve("flight.duckdb")
    assert(recorder.writeTo(file).isRight)
    val counts = RosBag.write(file, folder.resolve("bag")).fold(fail(_), identity)
    val lines  = run("read", folder.resolve("bag").toString).linesIterator.toVector.map(_.split(' '))
    assertEquals(lines.map(line => line(0) -> line(2).toLong).toMap, counts.toMap)
    for line <- lines do
      // Readings arrive over the link half a round trip after they were sampled; commands are stamped when
      // they are sent.
      val late = line(3).toDouble
      if line(0).endsWith("cmd_vel") then assertEqualsDouble(late, 0, 1e-3)
      else assert(late > 20 && late < 100, late)

  folder.test("we read rosbags' bags: each command is as old as its reading"): folder =>
    val bag = folder.resolve("bag")
    run("write", bag.toString): Unit
    val loop            = BagLoop(Set.empty, Set.empty).observed(bag).fold(fail(_), identity)
    val Vector(vehicle) = loop.vehicles: @unchecked
    assertEquals((vehicle.name, vehicle.commands), ("uav1", 40L))
    assertEqualsDouble(vehicle.ownAgeMs.get.mean, 34, 1e-6)
    assertEqualsDouble(vehicle.everyMs.get.mean, 100, 1e-6)
    assertEqualsDouble(loop.topics.head.lateMs.get.mean, 30, 1e-6)
    assert(Files.exists(bag.resolve("metadata.yaml")))

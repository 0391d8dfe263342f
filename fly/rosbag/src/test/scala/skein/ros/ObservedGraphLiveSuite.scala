package skein.ros

import skein.rosbag.GraphLoop
import skein.testing.{Conclusive, Lengthy, Waiting}
import skein.units.Clock

/** The observation of a running graph: our vehicles, and an outside pilot by `rclpy` with a known delay. */
class ObservedGraphLiveSuite extends munit.FunSuite, Conclusive, Lengthy, Waiting:

  for speed <- Seq(1, 4) do
    test(
      s"a pilot that sleeps 150 ms between reading and command is reported with that delay, at speed $speed"
    ):
      conclusive:
        val variables    = RosHere.variables()
        val served       = ServedProcess.start(variables, speed, port = 0)
        val observer     = ServedProcess.start(ServedProcess.program(variables, "observeOnRos"))
        val (status, by) = RosHere.python.run("late_pilot.py", RosHere.Domain, "10", "150", "a", "b")
        val ended        = observer.close()
        served.close(): Unit
        println(s"$by\n$ended")
        assertEquals(status, 0, by)
        val inside   = by.linesIterator.find(_.startsWith("PASSED ")).get.split(' ')(1).toDouble
        val told     = ended.linesIterator.filter(_.startsWith("vehicle ")).map(_.split(' ')).toVector
        val commands = told.map(words => words(1) -> words(2).toLong).toMap
        val age      = told.map(words => words(1) -> words(3).toDouble).toMap
        val Array(step, caused) =
          ended.linesIterator.find(_.startsWith("step ")).get.split(' ').drop(1).map(_.toDouble): @unchecked
        assertEqualsDouble(step, 20, 1)
        assertEqualsDouble(age("a"), inside, step + Apart * speed)
        assert(age("a") > 150 * speed - step, ended)
        // Which reading caused a command to b is not known: the newest is assumed, up to a period old.
        assert(age("b") < step + (step + Apart) * speed, ended)
        // A reading may be lost on its way to the observer: best effort.
        assert(caused <= commands("a") && caused >= 0.9 * commands("a"), ended)
        assert(commands("a") >= 40, ended)
        for fault <- Seq("did not appear", "expected", "refused") do assert(!ended.contains(fault), ended)

  /** Time from the pilot's reading of the clock to the observer's receipt of its command, ms of real time. */
  private val Apart = 10.0

/** Observes the graph until its input ends. */
@main def observeOnRos(): Unit =
  GraphLoop.open(Set.empty, Set.empty, Clock.system) match
    case Left(why) =>
      println(why)
      sys.exit(1)
    case Right(loop) =>
      println("serving")
      while System.in.read() >= 0 do ()
      loop.close()
      val observed = loop.observed
      for vehicle <- observed.vehicles; ages <- vehicle.ownAgeMs do
        println(s"vehicle ${vehicle.name} ${vehicle.commands} ${ages.median}")
      for simulated <- observed.simulated do
        println(s"step ${simulated.step.toMillis} ${observed.caused}")
      println(s"remarks: ${loop.remarks.mkString("; ")}")
      println(s"before: ${observed.simulated.map(_.before)}, lost: ${observed.notKept}")

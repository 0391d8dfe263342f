package skein.vtime

import java.util.concurrent.{Callable, Executors}
import org.apache.pekko.actor.{ActorSystem, Props}
import org.apache.pekko.stream.{KillSwitches, OverflowStrategy}
import org.apache.pekko.stream.scaladsl.{Sink, Source}
import scala.concurrent.Future
import skein.testing.Unhurried

/** Equal seeds give equal runs: in one JVM, in several, and in parallel. */
class DeterminismSimulation extends munit.FunSuite, Unhurried:

  test("a graph has equal logs for equal seeds, and another log for another seed"):
    val first = SampleGraph.digest(3)
    (1 to 5).foreach(_ => assertEquals(SampleGraph.digest(3), first))
    assertNotEquals(SampleGraph.digest(4), first)

  test("two loops on parallel threads have the results that each has alone"):
    val alone   = Seq(3L, 4L).map(SampleGraph.digest(_))
    val threads = Executors.newFixedThreadPool(2)
    try
      val together = Seq(3L, 4L, 3L, 4L, 3L, 4L).map: seed =>
        threads.submit((() => SampleGraph.digest(seed)): Callable[String])
      assertEquals(together.map(_.get()), Seq.fill(3)(alone).flatten)
    finally threads.shutdown()

  test("actors, also those of streams, have equal names and numbers in every run"):
    def names() = VirtualTime.run(1): system =>
      given ActorSystem = system
      val actor         = system.actorOf(Props(Silent()))
      val inStream      =
        Source.actorRef[Int](PartialFunction.empty, PartialFunction.empty, 1, OverflowStrategy.fail)
      val streamActor = inStream.to(Sink.ignore).run()
      Future.successful((actor.toString, streamActor.toString))
    val first = names().value
    assert(clue(first)._2.contains("StreamSupervisor-1/"))
    assertEquals(names().value, first)

  test("a shared kill switch ends its streams in an equal order in every run"):
    def ended() = VirtualTime.run(1): system =>
      given ActorSystem = system
      import system.dispatcher
      val switch = KillSwitches.shared("all")
      val order  = Vector.newBuilder[Int]
      val ends   = (1 to 20).map: stream =>
        Source.maybe[Int].via(switch.flow).runWith(Sink.ignore).andThen(_ => order += stream)
      switch.shutdown()
      Future.sequence(ends).map(_ => order.result())
    val first = ended().value
    (1 to 5).foreach(_ => assertEquals(ended().value, first))

  test("classes of packages named to the agent read virtual time and seeded randomness, and may not sleep"):
    val Array(clocks, draws, again, sleeps) =
      OtherJvm.run(
        "skein.vtime.listed.readEverything",
        agentOption = "=skein.vtime.listed"
      ).split('|'): @unchecked
    val (inUtc, inTokyo) = ("00:00:01.500", "09:00:01.500")
    assertEquals(
      clocks.split(";").toSeq,
      Seq(s"2000-01-01T${inUtc}Z", "true") ++
        Seq("2000-01-01", inUtc, s"2000-01-01T$inUtc", s"2000-01-01T${inUtc}Z", s"2000-01-01T${inUtc}Z") ++
        Seq(
          "2000-01-01",
          inTokyo,
          s"2000-01-01T$inTokyo",
          s"2000-01-01T$inTokyo+09:00",
          s"2000-01-01T$inTokyo+09:00[Asia/Tokyo]"
        ) ++
        Seq(
          s"2000-01-01T${inUtc}Z",
          "946684801500",
          "Z",
          "SourceClock[Redirected,Asia/Tokyo]",
          "946684801500",
          "946684801500"
        )
    )
    for ((one, other), place) <- draws.split(";").zip(again.split(";")).zipWithIndex do
      assertEquals(other, one, s"draw $place of seed 5")
    assertEquals(draws.split(";").length, again.split(";").length)
    for (sleep, call) <- sleeps.split(";").zip(Seq("Thread.sleep", "Thread.sleep", "TimeUnit.SECONDS.sleep"))
    do
      assert(clue(sleep).startsWith(s"Blocked($call"))

  test("another JVM gives an equal log"):
    assertEquals(OtherJvm.run("skein.vtime.sampleGraphDigest", Seq("3")), SampleGraph.digest(3))

  test("without the agent, a run is refused immediately, and the option to add is shown"):
    val refused = OtherJvm.run("skein.vtime.withoutAgent", withAgent = false)
    assert(clue(refused).startsWith("refused: virtual time needs its agent"))
    assert(refused.contains("-javaagent:/"))

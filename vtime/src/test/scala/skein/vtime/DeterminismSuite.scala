package skein.vtime

import java.util.concurrent.{Callable, Executors}
import org.apache.pekko.actor.{ActorSystem, Props}
import org.apache.pekko.stream.{KillSwitches, OverflowStrategy}
import org.apache.pekko.stream.scaladsl.{Sink, Source}
import scala.concurrent.Future

/** Equal seeds give equal runs: in one JVM, in several, and beside one another. */
class DeterminismSuite extends munit.FunSuite:

  test("a graph gives the same log over repeats, and another one for another seed"):
    val first = SampleGraph.digest(3)
    (1 to 5).foreach(_ => assertEquals(SampleGraph.digest(3), first))
    assertNotEquals(SampleGraph.digest(4), first)

  test("two loops in two threads at once give what each gives alone"):
    val alone   = Seq(3L, 4L).map(SampleGraph.digest(_))
    val threads = Executors.newFixedThreadPool(2)
    try
      val together = Seq(3L, 4L, 3L, 4L, 3L, 4L).map: seed =>
        threads.submit((() => SampleGraph.digest(seed)): Callable[String])
      assertEquals(together.map(_.get()), Seq.fill(3)(alone).flatten)
    finally threads.shutdown()

  test("actors have the same names and numbers in every run, those of streams too"):
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

  test("a shared kill switch ends its streams in the same order in every run"):
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
    val lines =
      OtherJvm.run("skein.vtime.listed.readEverything", agentOption = "=skein.vtime.listed").split(";")
    val (read, again) = (lines.take(6).toSeq, lines.takeRight(6).toSeq)
    assertEquals(read.take(2), Seq("2000-01-01T00:00:01.500Z", "true"))
    assertEquals(again, read)
    assert(clue(lines(6)).startsWith("Blocked(Thread.sleep"))

  test("another JVM gives the same log"):
    assertEquals(OtherJvm.run("skein.vtime.sampleGraphDigest", Seq("3")), SampleGraph.digest(3))

  test("without the agent, a run is refused at once, and the option to add is shown"):
    val refused = OtherJvm.run("skein.vtime.withoutAgent", withAgent = false)
    assert(clue(refused).startsWith("refused: virtual time needs its agent"))
    assert(refused.contains("-javaagent:/"))

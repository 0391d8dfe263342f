package skein.loop

import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.{Flow, Keep, Sink, Source}
import org.apache.pekko.stream.{Attributes, KillSwitches, SystemMaterializer}
import scala.concurrent.{Await, Future}
import scala.concurrent.duration.*
import skein.testing.Unhurried

class RunningGraphLiveSuite extends munit.FunSuite, Unhurried:

  test("the interpreter reports the named parts of a running graph, and its edges"):
    given system: ActorSystem = ActorSystem("graph")
    import system.dispatcher
    try
      val (mine, others)           = (StageMeters(), StageMeters())
      def run(meters: StageMeters) =
        def part(name: String) = Flow[Int].map(_ + 1).map(_ * 2).addAttributes(Attributes(meters(name)))
        Source.maybe[Int].via(part("one")).viaMat(KillSwitches.single)(Keep.right).via(part(
          "two"
        )).to(Sink.ignore).run()
      val switches = Vector(others, mine).map(run)
      // A stream that has just started reports nothing yet.
      val graph = RunningGraph(mine, Future.successful(SystemMaterializer(system).materializer))
      val found = Iterator.continually(Await.result(graph.shape(), 10.seconds)).flatten.next()
      assertEquals((found.stages.toSet, found.edges), (Set("one", "two"), Vector((from = "one", to = "two"))))
      switches.foreach(_.shutdown())
    finally Await.result(system.terminate(), 10.seconds): Unit

  test("a flight's graph is reported whatever the actor system's other streams do"):
    given system: ActorSystem = ActorSystem("graph-beside-others")
    val released              = java.util.concurrent.CountDownLatch(1)
    val entered               = java.util.concurrent.CountDownLatch(1)
    try
      // It answers nothing while it waits.
      Source
        .single(1)
        .map: _ =>
          entered.countDown()
          released.await()
        .runWith(Sink.ignore): Unit
      entered.await()
      val told = LoopInstance.graph(LoopKind.Stream, skein.scenario.PaperDuel().fleet)
      assert(Await.result(told, 25.seconds).exists(_.stages.nonEmpty))
    finally
      released.countDown()
      Await.result(system.terminate(), 10.seconds): Unit

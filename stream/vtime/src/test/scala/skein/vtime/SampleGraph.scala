package skein.vtime

import java.security.MessageDigest
import java.util.HexFormat
import org.apache.pekko.NotUsed
import org.apache.pekko.actor.{Actor, ActorSystem, Props}
import org.apache.pekko.pattern.{after, ask}
import org.apache.pekko.stream.scaladsl.{Broadcast, GraphDSL, Merge, MergeLatest, RestartSource, Sink, Source}
import org.apache.pekko.stream.{OverflowStrategy, RestartSettings, SourceShape}
import org.apache.pekko.util.Timeout
import scala.concurrent.Future
import scala.concurrent.duration.*
import scala.util.Random

/** A graph for two vehicles: ticks, asks that sometimes time out, joins, buffers, throttles, delays and
  * restarts.
  */
private object SampleGraph:

  /** SHA-256 over all events with their times. */
  def digest(seed: Long, graphs: Int = 1, duration: FiniteDuration = 20.seconds): String =
    val events = VirtualTime.run(seed): system =>
      import system.dispatcher
      Future.sequence((1 to graphs).map(number => run(system, Random(seed + number), duration)))
    .value.flatten
    assert(events.size > 20 * duration.toSeconds * graphs, s"only ${events.size} events")
    HexFormat.of.formatHex(
      MessageDigest.getInstance("SHA-256").digest(events.mkString("\n").getBytes("UTF-8"))
    )

  /** Every event as text, with the time in nanoseconds. */
  def run(system: ActorSystem, random: Random, duration: FiniteDuration): Future[Seq[String]] =
    given ActorSystem = system
    given Timeout     = 120.millis
    import system.dispatcher
    val clock   = VirtualTime.clock(system)
    val vehicle = system.actorOf(Props(Vehicle(random)))

    def sense(name: String, offset: FiniteDuration) =
      Source
        .tick(offset, 100.millis, name)
        .mapAsync(4)(name =>
          (vehicle ? name).mapTo[String].recover { case error => s"$name: ${error.getClass}" }
        )

    val noise = RestartSource.withBackoff(RestartSettings(50.millis, 2.seconds, 0.4)): () =>
      Source.tick(10.millis, 70.millis, "noise").takeWithin(random.between(100, 900).millis)

    val both = Source.fromGraph(GraphDSL.create(): builder =>
      given GraphDSL.Builder[NotUsed] = builder
      import GraphDSL.Implicits.*
      val evader  = builder.add(sense("evader", 0.millis))
      val pursuer = builder.add(sense("pursuer", 50.millis))
      val merge   = builder.add(Merge[String](2))
      val latest  = builder.add(MergeLatest[String](2))
      val copies  = builder.add(Broadcast[String](2))
      val joined  = builder.add(Merge[String](2))
      evader ~> merge
      pursuer ~> merge ~> copies ~> joined
      copies ~> latest
      noise ~> latest
      latest.out.map(_.mkString("(", ", ", ")")) ~> joined
      SourceShape(joined.out))

    both
      .buffer(1, OverflowStrategy.dropHead)
      .throttle(1, 31.millis)
      .delay(77.millis)
      .keepAlive(60.millis, () => "silence")
      .takeWithin(duration)
      .map(event => s"${clock()} $event")
      .runWith(Sink.seq)

  private final class Vehicle(random: Random) extends Actor:
    import context.{dispatcher, system}

    def receive: Receive = { case name: String =>
      val asker = sender()
      after(random.between(5, 140).millis)(Future.successful(s"$name ${random.nextInt()}"))
        .foreach(asker ! _)
    }

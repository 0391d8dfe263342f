package skein

import org.apache.pekko.Done
import org.apache.pekko.actor.ActorSystem
import org.apache.pekko.stream.scaladsl.Sink
import scala.concurrent.Future
import skein.airsim.Multirotor
import skein.flow.*
import skein.units.*

/** The README's example, between the marks. */
object ReadmeExample:

  def circle(drone: Multirotor, clock: Clock)(using ActorSystem): Future[Done] =
    // README begins
    val period = Span.ofMillis(100)
    Sense
      .every(period)(() => drone.kinematics())(onSkip = println, onMissed = println)
      .via(Pace(period / 2, clock)(unused => println(s"too old: $unused")))
      .via(Decide.withMemory(start = Option.empty[Instant]): (begun, seen) =>
        println(f"${seen.roundTrip.toMillis}%.0f ms there and back, at ${seen.value.positionNed}")
        val since      = begun.getOrElse(seen.validAt)
        val headingRad = 0.5 * seen.validAt.since(since).toSeconds
        (Some(since), Vector3(5 * math.cos(headingRad), 5 * math.sin(headingRad), 0)))
      .via(Steer(minInterval = period / 2, clock)(
        send = velocityNed => drone.moveByVelocityZ(velocityNed, down = Metres(-20), Span.ofSeconds(10)),
        park = () => drone.hover()
      ))
      .runWith(Sink.ignore)
    // README ends

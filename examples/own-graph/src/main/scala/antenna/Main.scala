package antenna

import java.nio.file.{Files, Path}
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.duration.*
import skein.units.*

/** Tracks the balloon for 40 s and draws what happened. */
@main def run(): Unit =
  given system: ActorSystem = ActorSystem("antenna")
  import system.dispatcher
  val field = Field(Clock.system, seed = 1)
  system.scheduler.scheduleAtFixedRate(1.second, 1.second): () =>
    field.watch()
    val (atS, bearing, azimuth) = field.track.last
    println(
      f"$atS%4.0f s  balloon ${math.toDegrees(bearing)}%6.1f°  antenna ${math.toDegrees(azimuth)}%6.1f°"
    )
  Antenna
    .track(field.instruments, Clock.system, Span.ofSeconds(40), println)
    .onComplete: ended =>
      ended.failed.foreach(println)
      val picture = Files.writeString(Path.of("antenna.svg"), Picture.of(field.track))
      println(s"drawn in $picture")
      system.terminate()

package skein.record

import java.nio.file.Path
import org.apache.pekko.actor.ActorSystem
import scala.concurrent.Await
import scala.concurrent.duration.*
import skein.units.Clock

/** A process that records one truth row every millisecond into the file of its first argument until it is
  * killed or recording fails, for 20 s at most, and prints each row's number, or the reason, when it has been
  * offered.
  */
object RecordUntilStopped:
  def main(arguments: Array[String]): Unit =
    given system: ActorSystem = ActorSystem("record")
    val file                  = Path.of(arguments(0))
    val recorder              = Await.result(DuckDbRecorder.open(file, Samples.heading), 60.seconds) match
      case Right(recorder) => recorder
      case Left(error)     => sys.error(error.message)
    val padding = "x" * 1000
    val numbers = Iterator.range(0, 20_000).takeWhile(_ => !recorder.failure.isCompleted)
    for number <- numbers do
      recorder.offer(Event(Clock.system.now(), EventKind.Dropped, Some(number.toString), padding))
      println(number)
      Thread.sleep(1)
    println(Await.result(recorder.close(), 10.seconds).fold(_.message, _.toString))
    sys.exit(0)

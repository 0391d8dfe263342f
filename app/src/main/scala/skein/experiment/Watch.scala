package skein.experiment

import scala.concurrent.Future
import skein.record.{Decision, Record, Recorder, RecordError, Written}
import skein.units.*

/** Records as `recorder` does, and remembers the newest decision for whoever watches the flight. */
final class Watch(recorder: Recorder) extends Recorder:
  @volatile private var newest: Option[Decision] = None

  def offer(record: Record): Unit =
    record match
      case decision: Decision => newest = Some(decision)
      case _                  => ()
    recorder.offer(record)

  def failure: Future[RecordError]                  = recorder.failure
  def close(): Future[Either[RecordError, Written]] = recorder.close()

  /** Distance between a vehicle and its opponent, m, and the age of the own reading, at the newest decision. */
  def sight: Option[Sight] = newest.map: decision =>
    Sight(
      Metres(
        decision.own.state.value.positionNed.horizontalDistance(decision.opponent.state.value.positionNed)
      ),
      decision.trueAge.fold(decision.observations.ownAge)(_.own)
    )

/** What a decision was based on, in two numbers. */
final case class Sight(distance: Metres, age: Span)

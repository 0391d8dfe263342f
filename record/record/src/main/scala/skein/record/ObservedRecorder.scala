package skein.record

import scala.concurrent.Future

/** Records as `recorder` does, and shows every record to `observer`, which must not wait for anything.
  *
  * @param keeps what is recorded; all is shown
  */
final class ObservedRecorder(
    recorder: Recorder,
    observer: Record => Unit,
    keeps: Record => Boolean = _ => true
) extends Recorder:
  def offer(record: Record): Unit =
    if keeps(record) then recorder.offer(record)
    observer(record)

  def failure: Future[RecordError]                  = recorder.failure
  def close(): Future[Either[RecordError, Written]] = recorder.close()

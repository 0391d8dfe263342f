package skein.record

import scala.concurrent.Future

/** Records as `recorder` does, and shows every record to `observer`, which must not wait for anything.
  *
  * @param keeps what is recorded; all is shown
  */
final class ObservedRecorder(
    recorder: Recorder,
    observer: Recordable => Unit,
    keeps: Recordable => Boolean = _ => true
) extends Recorder:
  def offer(record: Recordable): Unit =
    if keeps(record) then recorder.offer(record)
    observer(record)

  def failure: Future[RecordError]                  = recorder.failure
  def close(): Future[Either[RecordError, Written]] = recorder.close()

package skein.record

import scala.concurrent.Future

/** Records as `recorder` does, and shows every record to `observer`, which must not wait for anything. */
final class ObservedRecorder(recorder: Recorder, observer: Record => Unit) extends Recorder:
  def offer(record: Record): Unit =
    recorder.offer(record)
    observer(record)

  def failure: Future[RecordError]                  = recorder.failure
  def close(): Future[Either[RecordError, Written]] = recorder.close()

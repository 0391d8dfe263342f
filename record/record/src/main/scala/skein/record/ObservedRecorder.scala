package skein.record

import scala.concurrent.Future

/** Records like `recorder`, and passes every record to `observer`, which must not block.
  *
  * @param keeps selects the records to keep; all are passed to the observer
  */
final class ObservedRecorder(
    recorder: Recorder,
    observer: Recordable => Unit,
    keeps: Recordable => Boolean = _ => true
) extends Recorder:
  def offer(record: Recordable): Unit =
    if keeps(record) then recorder.offer(record)
    observer(record)

  export recorder.{close, failure}

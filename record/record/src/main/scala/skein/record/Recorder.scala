package skein.record

import scala.concurrent.Future

/** Takes the records of a flight. */
trait Recorder:

  /** Takes one record; never blocks, and makes no [[LaterRow]], from any thread. A record that cannot be kept
    * makes [[failure]] complete; after a failure or [[close]], records are ignored, except for the
    * [[Ending]], which is the last row and is written even after a failure if that is possible.
    */
  def offer(record: Recordable): Unit

  /** Completes when a record could not be kept, and never otherwise. The flight must end then: vehicles
    * hover, and the reason is shown.
    */
  def failure: Future[RecordError]

  /** Writes all waiting records and closes. Completes with the number of rows written, or with the failure.
    * Repeated calls return the result of the first.
    */
  def close(): Future[Either[RecordError, Written]]

package skein.signal

import skein.units.*

/** A reading and when it was true, asked for and answered. When it was used is known only at the decision, which
  * records it beside this.
  *
  * @param validAt
  *   when physics was sampled, on the simulator's clock
  * @param sentAt
  *   when the request left, on the controller's clock
  * @param receivedAt
  *   when the answer arrived, on the controller's clock
  */
final case class Stamped[+A](value: A, validAt: Instant, sentAt: Instant, receivedAt: Instant):
  def map[B](f: A => B): Stamped[B] = copy(value = f(value))

  /** Whether this tells of a later moment, by two readings alone: the simulator's clock says so, or it was asked for when
    * the other had come. Over a restart of the simulator [[ClockAlignment.isNewer]] knows better.
    */
  def isNewerThan(other: Stamped[?]): Boolean = validAt > other.validAt || sentAt > other.receivedAt

  /** The request's round trip on the controller's clock. */
  def roundTrip: Span = receivedAt.since(sentAt)

  /** Age by arrival: time since the answer arrived. The paper's published age; it hides the network's own delay. */
  def ageByArrival(usedAt: Instant): Span = usedAt.since(receivedAt)

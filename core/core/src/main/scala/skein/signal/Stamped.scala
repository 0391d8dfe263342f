package skein.signal

import skein.units.*

/** A reading with its valid time and the times of request and answer. The decision that uses it records a
  * time of its own.
  *
  * @param validAt time of the sampling of physics, on the simulator's clock
  * @param sentAt time of the request, on the controller's clock
  * @param receivedAt arrival time of the answer, on the controller's clock
  */
final case class Stamped[+A](value: A, validAt: Instant, sentAt: Instant, receivedAt: Instant):
  def map[B](f: A => B): Stamped[B] = copy(value = f(value))

  /** Whether this reading was sampled later than another, as far as the two alone show: on the simulator's
    * clock, or because it was requested after the other was received. Across a restart of the simulator, use
    * [[ClockAlignment.isNewer]].
    */
  def isNewerThan(other: Stamped[?]): Boolean =
    Stamped.isNewer(
      validAt.toNanos,
      sentAt.toNanos,
      other.validAt.toNanos,
      other.receivedAt.toNanos
    )

  /** The request's round trip on the controller's clock. */
  def roundTrip: Span = receivedAt.since(sentAt)

  /** Time since the answer arrived. This is the age that the paper publishes; it excludes the network's
    * delay.
    */
  def ageByArrival(usedAt: Instant): Span = usedAt.since(receivedAt)

object Stamped:
  /** [[Stamped.isNewerThan]] for readings given by their times, ns. */
  private[skein] def isNewer(
      validAtNs: Long,
      sentAtNs: Long,
      otherValidAtNs: Long,
      otherReceivedAtNs: Long
  ): Boolean =
    validAtNs > otherValidAtNs || sentAtNs > otherReceivedAtNs

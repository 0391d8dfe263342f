package skein.signal

import skein.units.*

/** A reading with its valid time and the times of request and answer. The decision that uses it records its
  * own time.
  *
  * @param validAt when physics was sampled, on the simulator's clock
  * @param sentAt when the request was sent, on the controller's clock
  * @param receivedAt when the answer arrived, on the controller's clock
  */
final case class Stamped[+A](value: A, validAt: Instant, sentAt: Instant, receivedAt: Instant):
  def map[B](f: A => B): Stamped[B] = copy(value = f(value))

  /** Whether this was sampled later, judged by the two readings alone: by the simulator's clock, or because
    * it was requested after the other was received. Across a restart of the simulator use
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

  /** Age by arrival: time since the answer arrived. The paper's published age; it excludes the network's
    * delay.
    */
  def ageByArrival(usedAt: Instant): Span = usedAt.since(receivedAt)

object Stamped:
  /** [[Stamped.isNewerThan]] by the times alone, ns. */
  private[skein] def isNewer(
      validAtNs: Long,
      sentAtNs: Long,
      otherValidAtNs: Long,
      otherReceivedAtNs: Long
  ): Boolean =
    validAtNs > otherValidAtNs || sentAtNs > otherReceivedAtNs

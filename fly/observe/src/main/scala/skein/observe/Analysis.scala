package skein.observe

import org.apache.pekko.util.ByteString
import skein.units.Instant

/** Analyses the messages between a program and its simulator, in the order in which they passed. Mutable; one
  * thread at a time. Instants are on the observer's clock.
  *
  * @tparam A the type of the observations
  */
trait Analysis[A]:
  def opened(connection: Int, at: Instant): Unit

  /** Takes bytes of a connection, split anywhere; datagrams arrive whole.
    *
    * @param isFromClient whether the side that connected sent them
    */
  def passed(connection: Int, isFromClient: Boolean, bytes: ByteString, at: Instant): Unit

  def closed(connection: Int, at: Instant): Unit

  /** Counts pieces that passed without analysis. */
  def passedOver(count: Long): Unit

  def progress: Progress

  /** Commands since the last call, for each vehicle. */
  def takeNew(): Vector[NewCommands]

  def observed: A

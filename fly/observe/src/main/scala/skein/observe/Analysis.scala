package skein.observe

import org.apache.pekko.util.ByteString
import skein.units.Instant

/** Analyses what passes between a program and its simulator. Mutable; one thread at a time; in the order in
  * which it passed. Instants are on the observer's clock.
  *
  * @tparam A what it observes
  */
trait Analysis[A]:
  def opened(connection: Int, at: Instant): Unit

  /** Takes bytes of a connection, split anywhere; datagrams come whole.
    *
    * @param isFromClient whether the side that connected sent them
    */
  def passed(connection: Int, isFromClient: Boolean, bytes: ByteString, at: Instant): Unit

  def closed(connection: Int, at: Instant): Unit

  /** Counts pieces that passed without analysis. */
  def passedOver(count: Long): Unit

  def progress: Progress

  /** Commands since the last call, by vehicle. */
  def takeNew(): Vector[NewCommands]

  def observed: A

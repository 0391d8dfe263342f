package skein.rpc

import skein.units.*

/** What one server gives its peers. Times are kept to one [[ServerLimits.Watch]].
  *
  * @param inFlightPerConnection most requests of one connection being handled; beyond that its socket is not
  *   read
  * @param inFlightAssured so many of them it may have whatever the others do
  * @param inFlightInCommon beyond those, for all connections together, first come, first served. What is
  *   being handled is what outlives the garbage collector: 50,000 requests of 200 greedy connections make its
  *   pauses ten times as long, and everybody wait
  * @param unsentBytesPerConnection a connection that has this many bytes of replies to take is not read until
  *   it has taken them
  * @param connections most connections open. One more takes the place of the first that has asked nothing
  *   yet, or of the one that has been silent for the longest time, if that is at least `silence`; else it is
  *   closed as it comes
  * @param heldBytesPerConnection memory that one connection may always make the server hold: messages under
  *   way, requests being handled, replies not taken
  * @param heldBytesInCommon memory beyond that, for all connections together. A connection whose requests and
  *   replies hold it is not read until some are answered and taken. One with nothing under way whose
  *   unfinished message finds none left is closed; a whole request, or a reply, that finds none left becomes
  *   an error
  * @param strays most values that are no messages between two requests; then the connection is closed, and
  *   before the first request at the first of them
  * @param messageTime longest time from a message's first byte to its last, while the server waits for it
  * @param replyTime longest time that a peer takes none of the replies that wait for it
  * @param silence how long a connection must be silent, with nothing under way, before a new one may take its
  *   place
  * @param waiting who says nothing for so long while it waits for an answer counts as silent from then on
  * @param idle a connection silent for so long, with nothing under way, is closed. AirSim's own clients think
  *   for minutes between two calls and do not connect again
  */
final case class ServerLimits(
    frame: FrameLimits = FrameLimits(),
    inFlightPerConnection: Int = 256,
    inFlightAssured: Int = 16,
    inFlightInCommon: Int = 1024,
    unsentBytesPerConnection: Int = 1 << 20,
    connections: Int = 256,
    heldBytesPerConnection: Long = 256 << 10,
    heldBytesInCommon: Long = 256 << 20,
    strays: Int = 1000,
    messageTime: Span = Span.ofSeconds(10),
    replyTime: Span = Span.ofSeconds(30),
    silence: Span = Span.ofSeconds(5),
    waiting: Span = Span.ofSeconds(60),
    idle: Span = Span.ofSeconds(3600)
):
  require(
    inFlightPerConnection > 0 && inFlightAssured > 0 && inFlightInCommon >= 0 &&
      unsentBytesPerConnection > 0 && connections > 0 &&
      heldBytesPerConnection > 0 && heldBytesInCommon >= 0 && strays >= 0,
    s"limits must be positive: $this"
  )
  require(
    Seq(messageTime, replyTime, silence, waiting, idle).forall(_ >= ServerLimits.Watch),
    s"times must be at least ${ServerLimits.Watch.toSeconds} s: $this"
  )

  /** The most memory that peers can make the server hold, bytes. A connection over its own part may still
    * finish what is small: hence twice that part.
    */
  def heldBytes: Long = heldBytesInCommon + 2L * connections * heldBytesPerConnection

object ServerLimits:
  /** How often a connection's times are looked at. */
  val Watch: Span = Span.ofSeconds(1)

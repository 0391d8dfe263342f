package skein.rpc

import skein.units.*

/** Limits of one server for its peers. Times are exact to one [[ServerLimits.Watch]].
  *
  * @param inFlightPerConnection maximum number of one connection's requests in progress; beyond that its
  *   socket is not read
  * @param inFlightAssured number of requests that each connection may have in progress whatever the others do
  * @param inFlightInCommon number of further requests for all connections together, first come, first served.
  *   Requests in progress survive garbage collections: 50,000 requests of 200 greedy connections make its
  *   pauses ten times as long
  * @param unsentBytesPerConnection a connection that has this many bytes of replies to take is not read until
  *   it has taken them
  * @param connections maximum number of open connections. A further one takes the place of the first that has
  *   requested nothing yet, or of the one that has been silent for the longest time, if that is at least
  *   `silence`; else it is closed on arrival
  * @param heldBytesPerConnection memory that one connection may always make the server hold: messages under
  *   way, requests in progress, replies not taken
  * @param heldBytesInCommon memory beyond that, for all connections together. A connection whose requests and
  *   replies hold it is not read until some are answered and taken. One without requests in progress whose
  *   unfinished message exceeds it is closed; a whole request, or a reply, that exceeds it becomes an error
  * @param strays maximum number of values between two requests that are not messages; beyond it the
  *   connection is closed. Before the first request, the first such value closes it
  * @param messageTime longest time from a message's first byte to its last, while the server waits for it
  * @param replyTime longest time without a peer taking any of its waiting replies
  * @param silence time for which a connection must be silent, with nothing in progress, before a new one may
  *   take its place
  * @param waiting a peer that sends nothing for this long while it awaits an answer counts as silent from
  *   then on
  * @param idle a connection silent for this long, with nothing in progress, is closed. AirSim's own clients
  *   think for minutes between two calls and do not connect again
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

  /** Greatest memory that peers can make the server hold, bytes. A connection that exceeds its own part may
    * still finish a small message: hence twice that part.
    */
  def heldBytes: Long = heldBytesInCommon + 2L * connections * heldBytesPerConnection

object ServerLimits:
  /** Interval at which a connection's time limits are checked. */
  val Watch: Span = Span.ofSeconds(1)

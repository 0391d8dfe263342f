package skein.cli

import skein.rpc.{ServerLimits, ServerStats}
import skein.simulator.PeerStats

/** Describes refused requests of clients to the person who runs a simulator. */
private[cli] object ServerNews:

  /** One line, or None if no request was refused. Equal lines mean that nothing has happened between them. */
  def line(
      stats: ServerStats,
      limits: ServerLimits,
      peers: PeerStats = PeerStats(),
      called: String = "MAVLink",
      hasHeldUp: Boolean = false
  ): Option[String] =
    val counts = happened(
      stats.turnedAway -> s"turned away because ${limits.connections} connections were open",
      stats.malformed  -> "closed for messages that were malformed or beyond a limit",
      stats.lacking    -> "requests and replies refused for more memory than was left for them",
      stats.overHeld   -> "closed for more memory than was left for them",
      stats.tooSlow    -> "closed for messages or replies that took too long",
      stats.idle       -> "closed for silence"
    )
    val dropped = happened(stats.dropped -> "calls of closed connections dropped")
    val ofPeers = happened(
      peers.damaged    -> "damaged frames",
      peers.dropped    -> "datagrams dropped for peers too slow",
      peers.turnedAway -> "peers turned away",
      peers.ignored    -> "datagrams ignored, of too many peers or too many at once",
      peers.foreign    -> "connections closed that spoke another protocol",
      peers.unanswered -> "times lockstep lost for want of an answer within a second; time goes on without it"
    )
    val moves = Option.when(hasHeldUp):
      "moves have held all workers for too long: from now on no call waits behind them, and the newest move of a " +
        "vehicle wins immediately"
    Option.when(counts.nonEmpty || dropped.nonEmpty || ofPeers.nonEmpty || hasHeldUp):
      val clients = Option.when(counts.nonEmpty)(s"clients: ${counts.mkString(", ")}")
      val others  = Option.when(ofPeers.nonEmpty)(s"$called: ${ofPeers.mkString(", ")}")
      val memory  = Option.when(counts.nonEmpty || dropped.nonEmpty):
        s"at most ${mebibytes(stats.mostHeldBytes)} of ${mebibytes(limits.heldBytes)} MiB were held for " +
          "clients at any time"
      (clients ++ dropped ++ others ++ moves ++ memory).mkString("; ")

  /** What has happened at all, each with its count. */
  def happened(counts: (Long, String)*): Seq[String] =
    counts.collect { case (count, what) if count > 0 => s"$count $what" }

  private def mebibytes(bytes: Long): Long = (bytes + (1 << 20) - 1) >> 20

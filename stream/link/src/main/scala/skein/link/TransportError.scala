package skein.link

import skein.units.Decimals.fixed
import skein.units.Span

/** The reasons why there is no connection or no listener. Futures and streams of a [[Transport]] fail with
  * one of these; the message states what was attempted, where, and what to do.
  */
enum TransportError(message: String, cause: Throwable | Null = null) extends RuntimeException(message, cause):

  /** The host answers, but no program listens at that port. */
  case NobodyListens(at: Address)
      extends TransportError(s"nobody listens at $at; is the program there started?")

  /** The host did not answer in time: it is off, elsewhere, or a firewall drops the request. */
  case NoAnswer(
      at: Address,
      after: Span
  ) extends TransportError(s"no answer from $at after ${after.toSeconds.fixed(1)} s; is the host reachable?")

  case UnknownHost(at: Address) extends TransportError(s"unknown host ${at.host}; check its name")

  case PortTaken(at: Address)
      extends TransportError(
        s"port ${at.port} of ${at.host} is taken; stop the other program or choose another port"
      )

  /** The system does not let this program listen there: not an address of this machine, or a privileged port.
    */
  case CannotListen(at: Address, reason: String) extends TransportError(s"cannot listen at $at: $reason")

  /** An open connection broke: reset by the other side, or by the network. */
  case Lost(to: Address, reason: String) extends TransportError(s"connection to $to lost: $reason")

  /** One side does not trust the other's certificate, or the other presents none. */
  case NotTrusted(at: Address, reason: Throwable)
      extends TransportError(
        s"no trusted connection to $at, ${TransportError.whoRefuses(reason)}: " +
          s"${reason.getMessage}; expected certificates of one set at both sides, which name the host",
        reason
      )

  /** The connecting peer speaks another protocol: see [[FirstBytes]]. */
  case Foreign(from: Address, what: String)
      extends TransportError(s"connection from $from closed: expected this port's own protocol, got $what")

  case Failed(to: Address, reason: Throwable)
      extends TransportError(s"connection to $to failed: ${reason.getMessage}", reason)

object TransportError:
  /** The side that refuses, by the wording of the JDK's TLS. */
  private def whoRefuses(reason: Throwable): String =
    def says(words: String) = s"${reason.getMessage}".contains(words)
    if says("Received fatal alert") then "which refuses what this side shows"
    else if says("terminated the handshake") || says("unrecognized SSL message") then
      "which does not answer as TLS does"
    else "whose side is refused here"

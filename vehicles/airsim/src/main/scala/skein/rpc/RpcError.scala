package skein.rpc

import skein.link.Address
import skein.units.*
import skein.units.Decimals.fixed

/** The reasons why a call has no result: an expected failure, so a value and never an exception. */
enum RpcError:

  /** No answer within the call's timeout. It may still run at the peer; a late answer is counted and dropped.
    */
  case Timeout(method: String, after: Span)

  /** The peer answered with an error; `text` is its own. */
  case Refused(method: String, text: String)

  /** The connection ended before the answer was received. `mayHaveRun`: the request had been sent. */
  case ConnectionLost(address: Address, mayHaveRun: Boolean, reason: String)

  /** The answer is not what was expected: bytes that are not reply, or a result of another type. */
  case Malformed(method: String, reason: String)

  /** Too many calls are in flight or waiting; the call was not sent. `limit` names the bound. */
  case Overloaded(method: String, limit: String)

  /** The client was closed before the answer was received. */
  case Cancelled(method: String)

  /** No connection to the peer could be opened; the call was not sent. */
  case Unreachable(address: Address, reason: String)

  /** One line for a person: what was expected, what was received, where. */
  def message: String = this match
    case Timeout(method, after) => s"$method: no answer within ${after.toMillis.fixed(0)} ms"
    case Refused(method, text)  => s"$method: refused by the peer: $text"
    case ConnectionLost(address, mayHaveRun, reason) =>
      s"connection to $address lost ($reason); the call ${
          if mayHaveRun then "may have run" else "has not run"
        }"
    case Malformed(method, reason)    => s"$method: malformed answer: $reason"
    case Overloaded(method, limit)    => s"$method: not sent, $limit"
    case Cancelled(method)            => s"$method: cancelled, the client was closed"
    case Unreachable(address, reason) => s"nothing answers at $address: $reason"

package skein.rpc

import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.Flow
import skein.units.*
import upack.Msg
import upickle.default.Reader

/** What a flow asks for one element. */
final case class RpcCall(method: String, params: Seq[Msg], options: CallOptions = CallOptions())

/** Calls of an RPC client as stages of a stream. */
object RpcFlow:

  /** Asks the peer once for each element and emits the answers in the order of the elements: the paper's ask.
    * An element whose call fails or comes late is passed over, counted in [[RpcStats.skipped]] and reported
    * as [[RpcEvent.Skipped]].
    *
    *   - '''Emits when''' the oldest call under way has its answer.
    *   - '''Backpressures when''' `parallelism` calls are under way or done and not yet emitted, or
    *     downstream does.
    *   - '''Completes when''' upstream has completed and no call is under way.
    *   - '''Cancels when''' downstream cancels.
    *
    * @param parallelism most calls under way; they wait for a place in the client's windows, which may be
    *   smaller, and are passed over only if more of them wait than [[RpcSettings.queue]] allows
    * @param timeout of each call, in place of the one in its options
    */
  def ordered[A, B: Reader](client: RpcClient, parallelism: Int, timeout: Span)(
      request: A => RpcCall
  ): Flow[A, TimedReply[B], NotUsed] =
    Flow[A]
      .mapAsync(parallelism): element =>
        val call = request(element)
        client
          .callStampedAs[B](
            call.method,
            call.params,
            call.options.copy(timeout = timeout, whenFull = WhenFull.Wait)
          )
          .map(_.left.map(error => client.skipped(call.method, error)))(using
            scala.concurrent.ExecutionContext.parasitic
          )
      .collect:
        case Right(answer) => answer

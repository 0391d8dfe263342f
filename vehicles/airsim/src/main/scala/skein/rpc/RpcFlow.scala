package skein.rpc

import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.Flow
import skein.units.*
import upack.Msg
import upickle.default.Reader

/** The call that a flow makes for one element. */
final case class RpcCall(method: String, params: Seq[Msg], options: CallOptions = CallOptions())

/** Makes calls of an RPC client as stream stages. */
object RpcFlow:

  /** Calls the peer once for each element and emits the answers in the order of the elements: the paper's
    * ask. An element whose call fails or times out is skipped, counted in [[RpcStats.skipped]] and reported
    * as [[RpcEvent.Skipped]].
    *
    *   - '''Emits when''' the oldest call in progress has its answer.
    *   - '''Backpressures when''' `parallelism` calls are in progress or done and not yet emitted, or
    *     downstream does.
    *   - '''Completes when''' upstream has completed and no call is in progress.
    *   - '''Cancels when''' downstream cancels.
    *
    * @param parallelism most calls in progress; they wait for a place in the client's windows, which may be
    *   smaller, and are skipped only if more of them wait than [[RpcSettings.queue]] allows
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

package skein.buffer

import org.apache.pekko.stream.stage.*
import org.apache.pekko.stream.{Attributes, BidiShape, Inlet, Outlet}
import org.apache.pekko.util.ByteString
import scala.collection.mutable
import scala.concurrent.{ExecutionContext, Future}
import scala.util.{Failure, Success, Try}
import skein.buffer.Buffers.Verdict
import skein.rpc.MessageWriter

/** Takes plans out of one connection between a client and its simulator, and answers them. All other bytes
  * pass unchanged and in order, in both directions. Answers to plans are inserted between two of the
  * simulator's messages.
  *
  *   - '''Emits when''' bytes have arrived that may pass; to the client also when a plan is answered.
  *   - '''Backpressures when''' a call waits for its verdict, downstream backpressures, or
  *     [[BufferStage.MostOwnBytes]] of answers to plans wait for the client.
  *   - '''Completes when''' that direction's upstream has completed and all of its bytes have been emitted.
  *   - '''Cancels when''' that direction's downstream cancels.
  */
private[buffer] final class BufferStage(judge: BufferStage.Judge)
    extends GraphStage[BidiShape[ByteString, ByteString, ByteString, ByteString]]:
  import BufferStage.*

  private val fromClient    = Inlet[ByteString]("BufferStage.fromClient")
  private val toSimulator   = Outlet[ByteString]("BufferStage.toSimulator")
  private val fromSimulator = Inlet[ByteString]("BufferStage.fromSimulator")
  private val toClient      = Outlet[ByteString]("BufferStage.toClient")

  val shape: BidiShape[ByteString, ByteString, ByteString, ByteString] =
    BidiShape(fromClient, toSimulator, fromSimulator, toClient)

  def createLogic(attributes: Attributes): GraphStageLogic = new GraphStageLogic(shape):
    private val calls   = ClientCalls()
    private val answers = SimulatorAnswers()
    private val writer  = MessageWriter()
    private val pieces  = mutable.Queue.empty[Piece]
    private var judging = Option.empty[Future[Verdict]] // of the first piece
    private var outward = ByteString.empty              // may pass to the simulator
    private var inward  = ByteString.empty              // may pass to the client
    private var own     = ByteString.empty              // answers to plans
    private val moves = mutable.LongMap.empty[String] // vehicles of moves that have passed, by the calls' ids
    private var ofClient  = Option.empty[Option[Throwable]] // its end
    private var ofServer  = Option.empty[Option[Throwable]]
    private var isPassing = false

    private val judged = getAsyncCallback[Try[Verdict]]: verdict =>
      judging = None
      verdict match
        case Success(known)   => follow(known)
        case Failure(failure) => failStage(failure)
      proceed()
      deliver()

    override def preStart(): Unit = pull(fromClient)

    override def postStop(): Unit =
      moves.valuesIterator.foreach(judge.answered)
      judging.foreach(_.foreach(noticed)(using ExecutionContext.parasitic))

    setHandler(
      fromClient,
      new InHandler:
        def onPush(): Unit =
          pieces ++= calls.offer(grab(fromClient))
          if calls.isLost then loseTrack()
          proceed()

        override def onUpstreamFinish(): Unit                    = end(None)
        override def onUpstreamFailure(failure: Throwable): Unit = end(Some(failure))

        private def end(failure: Option[Throwable]): Unit =
          pieces += Piece.Rest(calls.giveUp())
          ofClient = Some(failure)
          proceed()
    )

    setHandler(
      toSimulator,
      new OutHandler:
        def onPull(): Unit = proceed()

        override def onDownstreamFinish(cause: Throwable): Unit =
          pieces.clear()
          if !isClosed(fromClient) then cancel(fromClient, cause)
    )

    setHandler(
      fromSimulator,
      new InHandler:
        def onPush(): Unit =
          val bytes      = grab(fromSimulator)
          val (ids, end) = answers.offer(bytes)
          if answers.isLost then loseTrack()
          ids.foreach(id => moves.remove(id).foreach(judge.answered))
          end.filter(_ => own.nonEmpty) match
            case Some(place) =>
              inward = inward ++ bytes.take(place) ++ own ++ bytes.drop(place)
              own = ByteString.empty
            case None => inward = inward ++ bytes
          deliver()

        override def onUpstreamFinish(): Unit                    = end(None)
        override def onUpstreamFailure(failure: Throwable): Unit = end(Some(failure))

        private def end(failure: Option[Throwable]): Unit =
          ofServer = Some(failure)
          deliver()
    )

    setHandler(
      toClient,
      new OutHandler:
        def onPull(): Unit =
          deliver()
          proceed()

        override def onDownstreamFinish(cause: Throwable): Unit =
          if !isClosed(fromSimulator) then cancel(fromSimulator, cause)
    )

    /** Requests verdicts on the client's calls in order, and pushes what may pass to the simulator. */
    private def proceed(): Unit =
      while pieces.nonEmpty && judging.isEmpty do
        pieces.head match
          case Piece.Rest(bytes) =>
            outward = outward ++ bytes
            pieces.dequeue(): Unit
          case Piece.Call(wish, _, _) =>
            val verdict = judge.judge(wish)
            judging = Some(verdict)
            verdict.onComplete(judged.invoke)(using ExecutionContext.parasitic)
      if isClosed(toSimulator) then outward = ByteString.empty
      else
        if outward.nonEmpty && isAvailable(toSimulator) then
          push(toSimulator, outward)
          outward = ByteString.empty
        if pieces.isEmpty && outward.isEmpty then
          ofClient match
            case Some(failure) => failure.fold(complete(toSimulator))(fail(toSimulator, _))
            case None          =>
              if !hasBeenPulled(fromClient) && own.size < MostOwnBytes then pull(fromClient)

    private def follow(verdict: Verdict): Unit = pieces.removeHeadOption() match
      case Some(Piece.Call(_, id, bytes)) =>
        verdict match
          case Verdict.Pass(vehicle) =>
            outward = outward ++ bytes
            for name <- vehicle do
              // Without an id, or beyond the limit of moves, its answer would not be noticed.
              val before = id.fold(Option(name))(number =>
                if moves.size < MostMoves then moves.put(number, name) else Some(name)
              )
              before.foreach(judge.answered)
          case Verdict.Answer(answer) =>
            for number <- id if !isClosed(toClient) do
              writer.reply(number, answer)
              own = own ++ writer.take()
      case other =>
        // The simulator has closed its side meanwhile.
        require(other.isEmpty, s"judged $other")
        noticed(verdict)

    /** Reports a passed move as answered when its connection closed before the move was sent. */
    private def noticed(verdict: Verdict): Unit = verdict match
      case Verdict.Pass(vehicle) => vehicle.foreach(judge.answered)
      case Verdict.Answer(_)     => ()

    /** Pushes the simulator's bytes to the client, with the answers to plans. */
    private def deliver(): Unit =
      if isAvailable(toClient) then
        if !answers.isMidway then
          inward = inward ++ own
          own = ByteString.empty
        if inward.nonEmpty then
          push(toClient, inward)
          inward = ByteString.empty
        else if ofServer.isEmpty && !hasBeenPulled(fromSimulator) then pull(fromSimulator)
      if inward.isEmpty && (own.isEmpty || answers.isMidway) && !isClosed(toClient) then
        ofServer.foreach(failure => failure.fold(complete(toClient))(fail(toClient, _)))

    /** Passes all further bytes unchanged, since one side does not speak MessagePack. */
    private def loseTrack(): Unit =
      if !isPassing then
        isPassing = true
        own = ByteString.empty
        if !calls.isLost then pieces += Piece.Rest(calls.giveUp())
        judge.lost()
        // Bytes held for an incomplete message pass now.
        proceed()

private[buffer] object BufferStage:
  /** Maximum number of bytes of answers to plans that wait for the client. */
  val MostOwnBytes: Int = 64 << 10

  /** Maximum number of a connection's moves whose answers are awaited. Further moves count as answered when
    * they pass.
    */
  val MostMoves = 1024

  /** Decides on the calls of all connections together. Thread-safe. */
  trait Judge:
    def judge(wish: Wish): Future[Verdict]

    /** Reports that a passed move of a vehicle was answered, or that its answer will not be noticed. */
    def answered(vehicle: String): Unit

    /** Reports that a connection's bytes are no longer understood. */
    def lost(): Unit

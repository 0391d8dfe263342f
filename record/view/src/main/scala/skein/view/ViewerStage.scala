package skein.view

import org.apache.pekko.http.scaladsl.model.ws.{BinaryMessage, Message, TextMessage}
import org.apache.pekko.stream.*
import org.apache.pekko.stream.stage.*
import skein.units.Clock

/** One viewer's connection: its complete messages come in, messages for it go out.
  *
  * '''Emits when''' downstream pulls and something waits for the viewer. '''Backpressures when''' never;
  * waiting messages are bounded, and the newest wins. '''Completes when''' upstream has ended, in whichever
  * way, or the viewer has sent too many invalid messages. '''Cancels when''' downstream cancels.
  *
  * @param spoke called for each valid message
  */
private[view] final class ViewerStage(show: Show, clock: Clock, spoke: () => Unit)
    extends GraphStage[FlowShape[Message, Message]]:
  private val in  = Inlet[Message]("ViewerStage.in")
  private val out = Outlet[Message]("ViewerStage.out")

  val shape: FlowShape[Message, Message] = FlowShape(in, out)

  def createLogic(attributes: Attributes): GraphStageLogic =
    new GraphStageLogic(shape) with InHandler with OutHandler:
      private var refused = 0
      private val woken   = getAsyncCallback[Unit](_ => send())
      private val viewer  = Viewer(show.limits, show.channels.map(_.id).toSet, () => woken.invoke(()))

      override def preStart(): Unit =
        show.entered(viewer, clock.now())
        pull(in)

      override def postStop(): Unit = show.left(viewer)

      def onPush(): Unit =
        val most    = show.limits.messageBytes
        val message = grab(in) match
          case TextMessage.Strict(text) if text.length <= most     => Protocol.read(text)
          case BinaryMessage.Strict(bytes) if bytes.length <= most => Protocol.read(bytes)
          case _                                                   => Left(s"a message has up to $most bytes")
        message.flatMap(obey).fold(refuse, _ => spoke())
        if refused > show.limits.refusals then completeStage() else pull(in)

      /** Invalid frames are the viewer's mistake, not a failure of the server. */
      override def onUpstreamFailure(error: Throwable): Unit = completeStage()

      def onPull(): Unit = send()

      setHandlers(in, out, this)

      private def obey(message: ClientMessage): Either[String, Unit] = message match
        case ClientMessage.Subscribe(all) => each(all): (subscription, channel) =>
            viewer.subscribe(subscription, channel).map(_ => show.subscribed(viewer, subscription, channel))
        case ClientMessage.Unsubscribe(all)   => each(all)(viewer.unsubscribe)
        case playback: ClientMessage.Playback => show.control(playback, clock.now())
        case ClientMessage.NotOffered(op)     => Left(s"this server does not offer '$op'")

      private def each[A](all: Vector[A])(one: A => Either[String, Unit]): Either[String, Unit] =
        val refusals = all.flatMap(one(_).left.toOption)
        refusals.headOption.toLeft(())

      private def refuse(why: String): Unit =
        refused += 1
        viewer.notice("refused", TextMessage.Strict(Protocol.warning("refused", why)))

      private def send(): Unit = if isAvailable(out) then
        viewer.take().foreach(push(out, _))

package skein.flow

import org.apache.pekko.stream.stage.*
import org.apache.pekko.stream.{Attributes, FlowShape, Inlet, Outlet}
import skein.units.Span

/** Joins many inputs, keeping the newest value of each key. It waits up to `patience` for a new value of
  * every key, so that a decision does not mix new values of one key with old ones of another.
  *
  *   - '''Emits when''' every key has a value, all were renewed since the last emission or `patience` has
  *     passed since the first renewal, and downstream demands. With no patience, at every newer value.
  *   - '''Backpressures when''' never; values are joined until downstream demands.
  *   - '''Completes when''' upstream completes.
  *   - '''Cancels when''' downstream cancels.
  *
  * @param isNewer `isNewer(arrived, held)`: a late value never overrides a newer one
  * @param onStale called for every value dropped because a newer one was held
  */
final class JoinLatest[K, A](keys: Set[K], patience: Span)(
    isNewer: (A, A) => Boolean,
    onStale: (K, A) => Unit
) extends GraphStage[FlowShape[(K, A), Map[K, A]]]:
  private val in  = Inlet[(K, A)]("JoinLatest.in")
  private val out = Outlet[Map[K, A]]("JoinLatest.out")

  val shape: FlowShape[(K, A), Map[K, A]] = FlowShape(in, out)

  def createLogic(attributes: Attributes): GraphStageLogic =
    new TimerGraphStageLogic(shape) with InHandler with OutHandler:
      private var held    = Map.empty[K, A]
      private var renewed = Set.empty[K]
      private var due     = false

      override def preStart(): Unit = pull(in)

      def onPush(): Unit =
        val (key, value) = grab(in)
        if held.get(key).forall(isNewer(value, _)) then
          held = held.updated(key, value)
          renewed += key
          if held.size == keys.size then
            if renewed.size == keys.size || patience <= Span.Zero then due = true
            else if !isTimerActive(JoinLatest.Patience) then
              scheduleOnce(JoinLatest.Patience, patience.toDuration)
        else onStale(key, value)
        pull(in)
        emitWhenDue()

      def onPull(): Unit = emitWhenDue()

      override protected def onTimer(key: Any): Unit =
        due = true
        emitWhenDue()

      private def emitWhenDue(): Unit =
        if due && isAvailable(out) then
          due = false
          renewed = Set.empty
          cancelTimer(JoinLatest.Patience)
          push(out, held)

      setHandlers(in, out, this)

object JoinLatest:
  private case object Patience

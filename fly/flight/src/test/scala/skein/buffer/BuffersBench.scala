package skein.buffer

import scala.collection.mutable
import skein.buffer.Buffers.{Order, Stepped, Verdict}
import skein.signal.Stamped
import skein.simulator.{PlanCall, PlannedMove}
import skein.units.*
import upack.{Float32, Int32}

/** [[Buffers]] with a minimal simulator: it has a clock, answers readings, and answers a move when its time
  * has elapsed, or a handover after the next one arrived.
  *
  * @param roundTrip round trip between the buffer and the simulator
  * @param speed rate of the simulator's clock relative to the machine's
  */
private[buffer] final class BuffersBench(roundTrip: Span = Span.ofMillis(0.4), speed: Double = 1):
  import BuffersBench.*

  private val began  = Instant.Epoch + Span.ofSeconds(500)
  private val agenda = mutable.PriorityQueue.empty[(at: Instant, number: Long, act: () => Unit)](using
    Ordering.by(one => (-one.at.toNanos, -one.number))
  )
  private var number  = 0L
  private var clock   = began
  private var stopped = Option.empty[Instant] // since when, on the machine's clock
  private var stood   = Span.Zero
  private var flying  = Option.empty[Long]    // the simulator's newest move
  private var moves   = 0L

  var buffers: Buffers                                = Buffers()
  val performed: mutable.ArrayBuffer[Performed]       = mutable.ArrayBuffer.empty
  val verdicts: mutable.Map[Long, (Verdict, Instant)] = mutable.Map.empty
  var mostUnanswered: Int                             = 0

  /** Whether readings are answered. */
  var answers: Boolean = true

  def now: Instant = clock

  /** The time of the simulator's clock. */
  def simulated: Instant =
    val ran = stopped.getOrElse(clock).since(began) - stood
    Start + Span.ofNanos((ran.toNanos * speed).toLong)

  def pause(): Unit = stopped = stopped.orElse(Some(clock))

  def resume(): Unit =
    stopped.foreach(since => stood = stood + clock.since(since))
    stopped = None

  /** Runs `act` after a delay. */
  def after(ms: Double)(act: => Unit): Unit =
    number += 1
    agenda.enqueue((at = clock + Span.ofMillis(ms), number = number, act = () => act))

  /** Advances the time by `ms`. */
  def pass(ms: Double): Unit =
    val until = clock + Span.ofMillis(ms)
    while
      val wake = buffers.wakeAt(clock).map(_.max(clock))
      val next = (agenda.headOption.map(_.at) ++ wake).minOption.filter(_ <= until)
      next.foreach: at =>
        clock = at
        if agenda.headOption.exists(_.at <= at) then agenda.dequeue().act() else follow(buffers.due(clock))
      next.isDefined
    do ()
    clock = until

  def come(ticket: Long, wish: Wish): Unit = follow(buffers.received(ticket, wish, clock))

  /** Sends a plan for `Drone` with moves to the north at these times, in ms of the simulator's clock since
    * its start.
    */
  def plan(sequence: Long, times: Double*): Unit =
    val moves = times.map(time => north(time, sequence.toDouble)).toVector
    come(1_000_000 + sequence, Wish.Plan(Right(PlanCall(sequence, moves, "Drone"))))

  private def follow(step: Stepped): Unit =
    buffers = step.buffers
    step.orders.foreach:
      case Order.Judge(ticket, verdict) =>
        verdicts(ticket) = (verdict, clock)
        verdict match
          case Verdict.Pass(Some(vehicle)) => send(() => follow(buffers.answered(vehicle, clock)))
          case _                           => ()
      case Order.Look(vehicle) =>
        val sentAt = clock
        after(roundTrip.toMillis / 2):
          val shown = simulated
          after(roundTrip.toMillis / 2):
            val answer =
              if vehicle == "Nobody" then Left("there is no Nobody")
              else Right(Stamped((), shown, sentAt, clock))
            if answers then follow(buffers.looked(vehicle, answer, "Drone", clock))
      case Order.Move(vehicle, move) =>
        send(() => follow(buffers.ended(vehicle, isDone = true, clock)), Some(move))

  private var unanswered = 0

  /** Sends a move to the simulator, which then answers the previous one. */
  private def send(answered: () => Unit, move: Option[PlannedMove] = None): Unit =
    unanswered += 1
    mostUnanswered = mostUnanswered.max(unanswered)
    moves += 1
    val own = moves
    ends(own) = answered
    after(roundTrip.toMillis / 2):
      move.foreach(one => performed += Performed(simulated, clock, one))
      for before <- flying do after(HandoverMs)(end(before))
      flying = Some(own)

  private val ends = mutable.LongMap.empty[() => Unit]

  private def end(move: Long): Unit = after(roundTrip.toMillis / 2):
    ends.remove(move).foreach: answered =>
      unanswered -= 1
      answered()

private[buffer] object BuffersBench:
  val Start: Instant     = Instant.Epoch + Span.ofSeconds(3)
  private val HandoverMs = 0.3

  /** A move that the simulator has received. */
  final case class Performed(simulated: Instant, at: Instant, move: PlannedMove)

  /** A move by velocity for 10 s from `timeMs` on, in ms of the simulator's clock since its start. */
  def north(timeMs: Double, mps: Double): PlannedMove =
    val numbers = Vector(mps, 0, -20, 10).map(number => Float32(number.toFloat))
    val yaw     = upickle.default.writeMsg(skein.airsim.wire.YawMode.Still)
    PlannedMove(Start + Span.ofMillis(timeMs), "moveByVelocityZ", numbers ++ Vector(Int32(0), yaw))

package skein.forward

import skein.policy.Action

/** A loop in virtual time, which reacts to events. Each case of [[LoopTiming]] has an implementation.
  * Mutable.
  */
private[skein] trait LoopRun extends Controller.OnSent:
  import RolloutWorld.*

  protected def world: RolloutWorld

  def controllers: Array[Controller]

  def start(): Unit

  /** Handles an event of a request or of the loop's own clock. */
  final def handle(event: Long): Unit =
    val vehicle = vehicleOf(event)
    val number  = numberOf(event)
    kindOf(event) match
      case Tick     => tick(vehicle, number)
      case Sampled  => world.sampled(vehicle, number)
      case Answered =>
        world.received(vehicle, number)
        answered(vehicle, number)
      case TimedOut => timedOut(vehicle, number)
      case Patience => patienceOver()
      case Due      => due(number)

  /** Handles an event that was scheduled as `Tick`. */
  def tick(vehicle: Int, number: Int): Unit

  def answered(vehicle: Int, question: Int): Unit

  def timedOut(vehicle: Int, question: Int): Unit

  /** Handles an event that was scheduled as `Patience`. */
  def patienceOver(): Unit = ()

  /** Handles an event that was scheduled as `Due`. */
  def due(number: Int): Unit = ()

  def sent(agent: Int, number: Int, action: Action): Unit = ()

  /** Called when a command is answered because a newer one has replaced it. */
  def replaced(agent: Int, number: Int): Unit = ()

package skein.loop

import scala.concurrent.Future
import skein.rpc.RpcError
import skein.signal.{Kinematics, Stamped}
import skein.units.*

/** One vehicle as a loop sees it. Every call ends by itself, within its own timeout. */
trait Craft:

  /** Where the vehicle is, world NED. */
  def read(): Future[Either[RpcError, Stamped[Kinematics]]]

  /** Flies with a horizontal velocity at an altitude until the duration is over or a newer move replaces this one.
    * The answer comes then: true when the duration was flown, false when replaced.
    *
    * @param velocityNed
    *   m/s; the third component is ignored
    * @param down
    *   altitude goal, world NED
    */
  def move(velocityNed: Vector3, down: Metres, duration: Span): Future[Either[RpcError, Boolean]]

  /** Ends every move; the vehicle holds its position. */
  def hover(): Future[Either[RpcError, Boolean]]

/** Lets the simulator's time run in steps. */
trait Stepper:
  /** Stands the simulator still. */
  def pause(): Future[Either[RpcError, Unit]]

  /** Lets it run on by itself. */
  def resume(): Future[Either[RpcError, Unit]]

  /** Runs it for exactly `span`; answers when it stands still again. */
  def continueFor(span: Span): Future[Either[RpcError, Unit]]

package skein.flight

import java.util.concurrent.atomic.AtomicReference
import org.apache.pekko.Done
import scala.concurrent.{ExecutionContext, Future}

/** Holds resources that were opened, and closes them in the opposite order. */
private[skein] final class Opened(using ExecutionContext):
  private val closers = AtomicReference(List.empty[() => Future[Done]])

  /** Registers how `resource` is closed, and returns it. */
  def closing[A](resource: A)(close: A => Future[Done]): A =
    val _ = closers.updateAndGet((() => close(resource)) :: _)
    resource

  /** [[closing]] for a resource that closes immediately. */
  def closingNow[A](resource: A)(close: A => Unit): A = closing(resource): opened =>
    close(opened)
    Future.successful(Done)

  /** Closes all in turn, even if one fails; fails with the first failure. */
  def close(): Future[Done] =
    closers.getAndSet(Nil).foldLeft(Future.successful[Done](Done)): (before, close) =>
      before.transformWith(ended => close().transform(closed => ended.flatMap(_ => closed)))

package skein.link

import com.typesafe.config.Config
import java.util.concurrent.ForkJoinPool.{ForkJoinWorkerThreadFactory, ManagedBlocker}
import java.util.concurrent.{ForkJoinPool, ForkJoinWorkerThread, ThreadFactory}
import org.apache.pekko.dispatch.{DispatcherPrerequisites, ForkJoinExecutorConfigurator}
import scala.concurrent.{BlockContext, CanAwait}

/** Pekko's fork-join executor, with its settings, whose threads are [[ControlThreads]]. Chosen by a
  * dispatcher's `executor`; Pekko calls this constructor by reflection.
  */
final class ControlExecutor(config: Config, prerequisites: DispatcherPrerequisites)
    extends ForkJoinExecutorConfigurator(config.getConfig("fork-join-executor"), prerequisites):

  override def validate(factory: ThreadFactory): ForkJoinWorkerThreadFactory =
    val usual = super.validate(factory)
    (pool: ForkJoinPool) =>
      val like   = usual.newThread(pool)
      val thread = ControlExecutor.Worker(pool)
      thread.setName(like.getName)
      thread.setDaemon(like.isDaemon)
      thread.setContextClassLoader(like.getContextClassLoader)
      thread.setUncaughtExceptionHandler(like.getUncaughtExceptionHandler)
      thread

private object ControlExecutor:

  /** A worker that is replaced while it blocks, as Pekko's own are. */
  final class Worker(pool: ForkJoinPool) extends ForkJoinWorkerThread(pool), BlockContext:
    override def onStart(): Unit =
      super.onStart()
      ControlThreads.enter()

    override def onTermination(failure: Throwable | Null): Unit =
      ControlThreads.leave()
      super.onTermination(failure)

    def blockOn[T](thunk: => T)(using CanAwait): T =
      var result                  = Option.empty[T]
      val blocker: ManagedBlocker = new ManagedBlocker:
        def block(): Boolean =
          result = Some(thunk)
          true
        def isReleasable: Boolean = false
      ForkJoinPool.managedBlock(blocker)
      result.get

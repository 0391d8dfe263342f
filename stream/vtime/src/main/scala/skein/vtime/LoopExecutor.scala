package skein.vtime

import com.typesafe.config.Config
import java.util
import java.util.concurrent.{
  AbstractExecutorService,
  ExecutorService,
  RejectedExecutionException,
  ThreadFactory,
  TimeUnit
}
import org.apache.pekko.dispatch.{
  DispatcherPrerequisites,
  ExecutorServiceConfigurator,
  ExecutorServiceFactory,
  MessageDispatcher,
  MessageDispatcherConfigurator
}

/** Makes a dispatcher's executor run on the loop; named as `executor` in every dispatcher's configuration. */
private final class LoopExecutorConfigurator(config: Config, prerequisites: DispatcherPrerequisites)
    extends ExecutorServiceConfigurator(config, prerequisites):
  private val loop = Loop.current

  def createExecutorServiceFactory(id: String, threadFactory: ThreadFactory): ExecutorServiceFactory =
    new ExecutorServiceFactory:
      def createExecutorService: ExecutorService = LoopExecutor(loop)

/** Runs each task on the loop, in the order given. */
private final class LoopExecutor(loop: Loop) extends AbstractExecutorService with ExecutorService:
  private var closed = false

  def execute(task: Runnable): Unit =
    if closed then throw RejectedExecutionException("the dispatcher is shut down")
    loop.post(task)

  def shutdown(): Unit                                         = closed = true
  def shutdownNow(): util.List[Runnable]                       = { closed = true; util.List.of() }
  def isShutdown: Boolean                                      = closed
  def isTerminated: Boolean                                    = closed
  def awaitTermination(timeout: Long, unit: TimeUnit): Boolean = closed

/** Replaces a dispatcher that virtual time does not support: using it ends the run. */
private final class RefusedDispatcher(config: Config, prerequisites: DispatcherPrerequisites)
    extends MessageDispatcherConfigurator(config, prerequisites):

  def dispatcher(): MessageDispatcher =
    val id = config.getString("id")
    throw Loop.current.fail:
      if id == RefusedDispatcher.sockets then Problem.Sockets else Problem.NeedsThreads(id)

private object RefusedDispatcher:
  /** The name of the dispatcher on which Pekko would run its sockets. */
  val sockets = "skein.vtime.sockets"

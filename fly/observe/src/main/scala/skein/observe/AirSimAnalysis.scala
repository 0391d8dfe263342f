package skein.observe

import org.apache.pekko.util.ByteString
import scala.collection.mutable
import skein.units.Instant

/** Analyses the MessagePack-RPC of AirSim's clients. A call's name determines whether it is a command, a
  * reading or anything else.
  */
final class AirSimAnalysis extends Analysis[Observed]:
  private val account       = LoopAccount()
  private val conversations = mutable.LongMap.empty[Conversation]

  def opened(connection: Int, at: Instant): Unit =
    conversations(connection) = Conversation(connection)
    account.add(Passed.Opened(connection, at))

  def passed(connection: Int, isFromClient: Boolean, bytes: ByteString, at: Instant): Unit =
    for known <- conversations.get(connection) do
      val passed = if isFromClient then known.fromClient(bytes, at) else known.fromSimulator(bytes, at)
      passed.foreach(account.add)

  def closed(connection: Int, at: Instant): Unit =
    conversations.remove(connection): Unit
    account.add(Passed.Closed(connection, at))

  export account.{observed, passedOver, progress, takeNew}

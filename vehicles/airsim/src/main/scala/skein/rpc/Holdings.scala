package skein.rpc

import java.util.concurrent.atomic.AtomicLong

/** Limits what peers can make this process hold, over all connections of one server or client: bytes of
  * memory (incomplete messages, messages decoded and not yet answered, answers not yet taken), or requests in
  * progress; here all are called bytes.
  *
  * Every connection may hold `each` bytes whatever the others do; more is taken out of `common`, first come,
  * first served. So a peer that requests little is never refused because of one that requests much, and the
  * total is at most `common` and `each` for every connection. Safe from any thread.
  *
  * @param each bytes that a connection may always hold
  * @param common bytes that all connections together may hold beyond that
  */
private[rpc] final class Holdings(each: Long, common: Long):
  private val beyond = AtomicLong()
  private val inAll  = AtomicLong()
  private val most   = AtomicLong()

  def bytes: Long = inAll.get

  def mostBytes: Long = most.get

  /** One connection's share; for one thread at a time. */
  final class Holding:
    private var held   = 0L
    private var forced = 0L // bytes beyond its own part that were not granted

    /** Changes the bytes held to `to`, unless the common part is too small: then it returns false and changes
      * nothing.
      */
    def resize(to: Long): Boolean =
      val change  = beyondOwn(to) - beyondOwn(held)
      val granted = change <= 0 || takeCommon(change)
      if granted then
        if change < 0 then giveBack(-change)
        account(to)
      granted

    /** Changes the bytes held to `to`, granted or not, because they exist already. */
    def force(to: Long): Unit =
      if !resize(to) then
        val change = beyondOwn(to) - beyondOwn(held)
        val _      = beyond.addAndGet(change)
        forced += change
        account(to)

    /** Whether the common part now covers all bytes that the connection holds beyond its own part. */
    def isGranted: Boolean =
      if forced > 0 && beyond.get <= common then forced = 0
      forced == 0

    private def giveBack(bytes: Long): Unit =
      val _ = beyond.addAndGet(-bytes)
      forced = math.max(0, forced - bytes)

    private def beyondOwn(bytes: Long): Long = math.max(0, bytes - each)

    private def account(to: Long): Unit =
      if to != held then
        val now = inAll.addAndGet(to - held)
        held = to
        if now > most.get then
          val _ = most.accumulateAndGet(now, math.max(_, _))

  private def takeCommon(change: Long): Boolean =
    val before = beyond.get
    if before + change > common then false
    else beyond.compareAndSet(before, before + change) || takeCommon(change)

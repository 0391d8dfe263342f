package skein.simd

import java.util.concurrent.ConcurrentHashMap

/** A cache that forgets what is used least recently, shared by all threads. A lookup of what was used lately
  * takes no lock. After `most` other keys have been used, a value may be forgotten; after twice as many it
  * is.
  */
private[skein] final class Recent[K, V](most: Int):
  require(most > 0, s"expected at least one key to keep, got $most")
  @volatile private var now, before = ConcurrentHashMap[K, V]()

  /** The value of a key. Two threads may make it simultaneously; both get one of the two. */
  def getOrMake(key: K)(make: => V): V =
    val known = now.get(key)
    if known != null then known
    else
      val older = before.get(key)
      keep(key, if older != null then older else make)

  private def keep(key: K, value: V): V = synchronized:
    val other = now.get(key)
    if other != null then other
    else
      if now.size >= most then
        before = now
        now = ConcurrentHashMap()
      now.put(key, value): Unit
      value

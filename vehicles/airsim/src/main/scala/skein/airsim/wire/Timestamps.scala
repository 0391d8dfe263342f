package skein.airsim.wire

import skein.units.Instant
import upickle.core.Visitor
import upickle.default.{ReadWriter, Reader, Writer}

/** Time stamps are nanoseconds on the simulator's clock, unsigned 64-bit. */
private[skein] given ReadWriter[Instant] =
  val writer = new Writer[Instant]:
    def write0[V](out: Visitor[?, V], at: Instant): V = out.visitUInt64(at.toNanos, -1)
  ReadWriter.join(using summon[Reader[Long]].map(Instant.ofNanos(_)), writer)

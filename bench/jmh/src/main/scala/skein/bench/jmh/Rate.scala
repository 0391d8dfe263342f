package skein.bench.jmh

import java.util.concurrent.TimeUnit
import org.openjdk.jmh.annotations.*

/** Settings of all benchmarks: a rate in millions a second, on one thread. */
@State(Scope.Benchmark)
@BenchmarkMode(Array(Mode.Throughput))
@OutputTimeUnit(TimeUnit.MICROSECONDS)
@Warmup(iterations = 3, time = 2)
@Measurement(iterations = 5, time = 1)
@Fork(value = 1, jvmArgsAppend = Array("--add-modules", "jdk.incubator.vector"))
abstract class Rate

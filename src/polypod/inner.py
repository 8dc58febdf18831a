"""Kernels that only kernels call: kept as LLVM's code, from which callers are made.

Numba optimises every function it compiles together with all that it calls, and makes machine code
of it. That of an inner kernel is never run: whoever calls it takes in its LLVM code. So both are
left to the kernel that Python calls. That took optimising from 24 to 6.5 s of processor time and
machine code from 21 to 5, of 106 s for all kernels.
"""

# mypy: allow-untyped-calls

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import binding
from numba.core.caching import CompileResultCacheImpl, FunctionCache
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, compile_result


class NoEngine:
    """Stands where Numba would tell its engine about machine code."""

    def set_env(self, name: str, environment: Any) -> None:
        """Do nothing: there is no code that would look for its environment."""


class InnerLibrary(JITCodeLibrary):
    """The code of one inner kernel and of all that it calls; never handed to the engine."""

    @property
    def codegen(self) -> Any:
        """What is told of machine code."""
        return NoEngine()

    def _optimize_final_module(self) -> None:
        """Leave it to the callers, who optimise all that they take in as one."""

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """Return 0: there is no machine code."""
        self._ensure_finalized()
        return 0

    def serialize_using_object_code(self) -> tuple[str, str, bytes]:
        """Return what the cache keeps."""
        self._ensure_finalized()
        return self.name, "bitcode", self._get_module_for_linking().as_bitcode()

    @classmethod
    def from_cache(cls, codegen: Any, kept: tuple[str, str, bytes]) -> InnerLibrary:
        """Return the library of what the cache kept."""
        name, _, code = kept
        library = cls(codegen, name)
        library._final_module = binding.parse_bitcode(code)
        library._shared_module = library._final_module
        library._finalize_final_module()
        return library


class InnerCompiler(Compiler):
    """Numba's compiler, with such a library to write to."""

    def compile_extra(self, func: Callable[..., Any]) -> Any:
        """Compile a function for the types that this was made for."""
        self.state.library = InnerLibrary(self.state.targetctx.codegen(), func.__qualname__)
        return super().compile_extra(func)


class InnerCacheEntries(CompileResultCacheImpl):
    """How the cache keeps inner kernels."""

    def rebuild(self, target_context: Any, payload: Any) -> Any:
        """Return the kernel that was kept."""
        kept, descriptor, environment, signature, object_mode, lifted, notes, reload, _ = payload
        library = InnerLibrary.from_cache(target_context.codegen(), kept)
        return compile_result(
            target_context=target_context,
            typing_context=target_context.typing_context,
            library=library,
            environment=environment,
            entry_point=target_context.get_executable(library, descriptor, environment),
            fndesc=descriptor,
            type_annotation=notes,
            signature=signature,
            objectmode=object_mode,
            lifted=lifted,
            reload_init=reload,
        )


class InnerCache(FunctionCache):
    """The cache of one inner kernel."""

    _impl_class = InnerCacheEntries


def make_inner(function: Callable[..., Any], njit: Any) -> Any:
    """Return Numba's dispatcher of a function's inner form; `njit` is how kernels are compiled."""
    inner = njit(no_cpython_wrapper=True, no_cfunc_wrapper=True, pipeline_class=InnerCompiler)
    dispatcher = inner(function)
    dispatcher._cache = InnerCache(function)
    return dispatcher

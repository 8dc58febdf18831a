"""The studio: a page where a creature walks and everything can be changed while it does.

Needs the extra `polypod[studio]`; docs/studio-protocol.md says what server and page tell each
other. Nothing here is compiled: a change of the page costs no new kernels.
"""
